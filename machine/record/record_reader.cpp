#include "machine/record/record_reader.h"

#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "machine/record/record_format.h"

namespace understudy::machine {
namespace {

constexpr std::size_t kFirstLine = 64;  // [bytes], at most

/// The payload of an entry, value by value. Reading beyond its end spoils it.
class Payload {
 public:
  Payload(std::string_view bytes, std::size_t axes) : rest_(bytes), axes_(axes) {}

  template <typename T>
  T take() {
    T value{};
    if (rest_.size() < sizeof(T)) {
      good_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }
  /// One of the words up to `last`.
  template <typename Enum>
  Enum take_word(Enum last) {
    const auto number = take<std::uint8_t>();
    if (number > static_cast<std::uint8_t>(last)) spoil();
    return good_ ? static_cast<Enum>(number) : Enum{};
  }
  Status take_answer() { return take_word(Status::no_frame); }
  void take_axes(AxisVector& values) {
    for (std::size_t i = 0; i < axes_; ++i) values[i] = take<double>();
  }
  Region take_region() {
    Region region;
    for (int* value : {&region.x, &region.y, &region.width, &region.height}) *value = take<std::int32_t>();
    return region;
  }
  std::string_view take_rest() { return std::exchange(rest_, {}); }
  /// So many values of at least `size` bytes can still follow.
  bool holds(std::size_t count, std::size_t size) const { return count <= rest_.size() / size; }
  bool good() const { return good_ && rest_.empty(); }
  void spoil() { good_ = false; }
  std::size_t axes() const { return axes_; }

 private:
  std::string_view rest_;
  std::size_t axes_;
  bool good_ = true;
};

RecordedSubmit read_submit(Payload& payload) {
  RecordedSubmit submit;
  submit.now = payload.take<double>();
  submit.deadline = payload.take<double>();
  submit.answer = payload.take_answer();
  const auto count = payload.take<std::uint32_t>();
  if (!payload.holds(count, (2 + 2 * payload.axes()) * sizeof(double) + sizeof(std::int32_t))) {
    payload.spoil();
    return submit;
  }
  submit.setpoints.resize(count);
  for (Setpoint& s : submit.setpoints) {
    s.time = payload.take<double>();
    payload.take_axes(s.position);
    payload.take_axes(s.velocity);
    s.filament = payload.take<double>();
    s.line = payload.take<std::int32_t>();
  }
  return submit;
}

AxisState read_state(Payload& payload) {
  AxisState s;
  s.time = payload.take<double>();
  s.sampled_at = payload.take<double>();
  payload.take_axes(s.position);
  s.accepted = payload.take<std::uint64_t>();
  s.executed = payload.take<std::uint64_t>();
  s.free_slots = static_cast<std::size_t>(payload.take<std::uint64_t>());
  s.moving = payload.take<std::uint8_t>() != 0;
  s.fault = payload.take_word(Fault::engine);
  return s;
}

RecordedFrame read_frame(Payload& payload) {
  RecordedFrame read;
  read.now = payload.take<double>();
  read.deadline = payload.take<double>();
  read.asked = payload.take_region();
  read.answer = payload.take_answer();
  if (read.answer != Status::ok) return read;
  read.frame.exposed_at = payload.take<double>();
  read.frame.received_at = payload.take<double>();
  read.frame.number = payload.take<std::uint64_t>();
  read.frame.image.region = payload.take_region();
  const std::string_view pixels = payload.take_rest();
  const Region& region = read.frame.image.region;
  if (region.width < 0 || region.height < 0 ||
      pixels.size() != static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height))
    payload.spoil();
  read.frame.image.pixels.assign(pixels.begin(), pixels.end());
  return read;
}

/// Nothing for a kind that this version does not know, and for a payload of another shape.
std::optional<RecordedEntry> read_entry(RecordKind kind, Payload payload) {
  RecordedEntry entry;
  switch (kind) {
    case RecordKind::note:
      entry = RecordedNote{std::string(payload.take_rest())};
      break;
    case RecordKind::submit:
      entry = read_submit(payload);
      break;
    case RecordKind::state:
      entry = read_state(payload);
      break;
    case RecordKind::wait: {
      const auto now = payload.take<double>(), until = payload.take<double>(), ended = payload.take<double>();
      entry = RecordedWait{now, until, ended, payload.take_answer()};
      break;
    }
    case RecordKind::urgent: {
      const auto now = payload.take<double>();
      const auto command = payload.take_word(UrgentCommand::clear_fault);
      entry = RecordedUrgent{now, command, payload.take_answer()};
      break;
    }
    case RecordKind::outputs: {
      const auto now = payload.take<double>(), deadline = payload.take<double>();
      const auto temperature = payload.take<double>(), fan = payload.take<double>();
      entry = RecordedOutputs{now, deadline, {temperature, fan}, payload.take_answer()};
      break;
    }
    case RecordKind::frame:
      entry = read_frame(payload);
      break;
    case RecordKind::load: {
      LoadReading load;
      load.sampled_at = payload.take<double>();
      payload.take_axes(load.position);
      entry = load;
      break;
    }
    default:
      return std::nullopt;
  }
  return payload.good() ? std::optional(std::move(entry)) : std::nullopt;
}

int axes_of(std::ifstream& file, const std::filesystem::path& path) {
  std::string first(kFirstLine, '\0');
  file.getline(first.data(), static_cast<std::streamsize>(first.size()));
  const std::streamsize line = file.gcount() - 1;  // without its end, which belongs to it
  int axes = 0, used = 0;
  const std::string format = std::string(kRecordMagic) + " %d%n";
  if (file.fail() || file.eof() || std::sscanf(first.c_str(), format.c_str(), &axes, &used) != 1 ||
      used != line || axes < 1 || axes > kMaxAxes)
    throw InputError({path.string(), 1},
                     fmt::format("it is no record of a port: its first line is not '{} N', "
                                 "N axes from 1 to {}",
                                 kRecordMagic, kMaxAxes));
  return axes;
}

}  // namespace

RecordEnd read_record(const std::filesystem::path& path,
                      const std::function<void(const RecordedEntry&)>& entry) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError({path.string()}, "it cannot be read");
  RecordEnd end;
  end.axes = axes_of(file, path);
  end.size = static_cast<std::uintmax_t>(file.tellg());
  std::string body;
  while (true) {
    std::uint32_t size = 0, sum = 0;
    if (!file.read(reinterpret_cast<char*>(&size), sizeof(size))) {
      end.whole = file.gcount() == 0;
      return end;
    }
    if (size > kEntryMax) return end;
    body.resize(std::size_t{1} + size);
    if (!file.read(body.data(), static_cast<std::streamsize>(body.size())) ||
        !file.read(reinterpret_cast<char*>(&sum), sizeof(sum)) || record_checksum(body) != sum)
      return end;
    const auto read =
        read_entry(static_cast<RecordKind>(body[0]),
                   Payload(std::string_view(body).substr(1), static_cast<std::size_t>(end.axes)));
    if (!read) return end;
    entry(*read);
    end.size = static_cast<std::uintmax_t>(file.tellg());
  }
}

}  // namespace understudy::machine
