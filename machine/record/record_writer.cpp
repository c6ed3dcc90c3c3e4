#include "machine/record/record_writer.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::machine {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");
constexpr std::size_t kUsual = 1 << 20;  // [bytes], between two flushes

}  // namespace

RecordWriter::RecordWriter(const std::filesystem::path& path, int axes, AppendFile::Begin begin)
    : file_(path, begin), axes_(static_cast<std::size_t>(axes)) {
  bytes_.reserve(kUsual);
  if (begin == AppendFile::Begin::anew) file_.append(fmt::format("{} {}\n", kRecordMagic, axes));
}

RecordWriter::~RecordWriter() {
  try {
    flush();
  } catch (const MachineError&) {  // a full disk: what was flushed before stands
  }
}

template <typename T>
void RecordWriter::put(const T& value) {
  static_assert(std::is_arithmetic_v<T>);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes_.append(raw, sizeof(T));
}

void RecordWriter::put_axes(const AxisVector& values) {
  for (std::size_t i = 0; i < axes_; ++i) put(values[i]);
}

void RecordWriter::put_region(const Region& region) {
  for (const int value : {region.x, region.y, region.width, region.height}) put(std::int32_t{value});
}

std::size_t RecordWriter::begin(RecordKind kind) {
  const std::size_t begun = bytes_.size();
  put(std::uint32_t{0});
  put(static_cast<std::uint8_t>(kind));
  return begun;
}

/// The size and the sum of kind and payload.
void RecordWriter::end(std::size_t begun) {
  const std::string_view body = std::string_view(bytes_).substr(begun + 4);
  const auto size = static_cast<std::uint32_t>(body.size() - 1);
  const std::uint32_t sum = record_checksum(body);
  std::memcpy(bytes_.data() + begun, &size, sizeof(size));
  put(sum);
}

void RecordWriter::note(std::string_view text) {
  const std::size_t begun = begin(RecordKind::note);
  bytes_ += text;
  end(begun);
}

void RecordWriter::submit(double now, double deadline, std::span<const Setpoint> setpoints, Status answer) {
  const std::size_t begun = begin(RecordKind::submit);
  put(now);
  put(deadline);
  put(static_cast<std::uint8_t>(answer));
  put(static_cast<std::uint32_t>(setpoints.size()));
  for (const Setpoint& s : setpoints) {
    put(s.time);
    put_axes(s.position);
    put_axes(s.velocity);
    put(s.filament);
    put(std::int32_t{s.line});
  }
  end(begun);
}

void RecordWriter::state(const AxisState& s) {
  const std::size_t begun = begin(RecordKind::state);
  put(s.time);
  put(s.sampled_at);
  put_axes(s.position);
  put(std::uint64_t{s.accepted});
  put(std::uint64_t{s.executed});
  put(static_cast<std::uint64_t>(s.free_slots));
  put(static_cast<std::uint8_t>(s.moving));
  put(static_cast<std::uint8_t>(s.fault));
  end(begun);
}

void RecordWriter::load(const LoadReading& reading) {
  const std::size_t at = begin(RecordKind::load);
  put(reading.sampled_at);
  put_axes(reading.position);
  end(at);
}

void RecordWriter::wait(double now, double until, double ended, Status answer) {
  const std::size_t begun = begin(RecordKind::wait);
  put(now);
  put(until);
  put(ended);
  put(static_cast<std::uint8_t>(answer));
  end(begun);
}

void RecordWriter::urgent(double now, UrgentCommand command, Status answer) {
  const std::size_t begun = begin(RecordKind::urgent);
  put(now);
  put(static_cast<std::uint8_t>(command));
  put(static_cast<std::uint8_t>(answer));
  end(begun);
}

void RecordWriter::outputs(double now, const Outputs& outputs, double deadline, Status answer) {
  const std::size_t begun = begin(RecordKind::outputs);
  put(now);
  put(deadline);
  put(outputs.nozzle_temperature);
  put(outputs.fan);
  put(static_cast<std::uint8_t>(answer));
  end(begun);
}

void RecordWriter::frame(double now, const Region& asked, double deadline, Status answer,
                         const Frame& frame) {
  const std::size_t begun = begin(RecordKind::frame);
  put(now);
  put(deadline);
  put_region(asked);
  put(static_cast<std::uint8_t>(answer));
  if (answer == Status::ok) {
    put(frame.exposed_at);
    put(frame.received_at);
    put(std::uint64_t{frame.number});
    put_region(frame.image.region);
    bytes_.append(frame.image.pixels.begin(), frame.image.pixels.end());
  }
  end(begun);
}

void RecordWriter::flush() {
  if (bytes_.empty()) return;
  file_.append(bytes_);
  bytes_.clear();
}

}  // namespace understudy::machine
