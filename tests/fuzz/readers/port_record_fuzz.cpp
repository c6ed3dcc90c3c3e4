// Bytes as a port record: a file as it is, or, so that the checksums do not keep everything out, entries that
// get their length and checksum here.
#include <cstring>

#include "machine/record/record_format.h"
#include "machine/record/record_reader.h"
#include "machine/record/record_writer.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using namespace understudy::machine;

template <typename T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Of a first byte that is no letter: the number of axes, then entries of a kind, a length and a payload.
std::string framed(std::string_view bytes) {
  if (bytes.empty() || bytes[0] == kRecordMagic[0]) return std::string(bytes);
  const auto byte = [&bytes](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  std::string file = std::string(kRecordMagic) + " " + std::to_string(byte(0) % kMaxAxes + 1) + "\n";
  for (std::size_t at = 1; at + 3 <= bytes.size();) {
    const std::size_t length =
        std::min<std::size_t>(byte(at + 1) + 256u * byte(at + 2), bytes.size() - at - 3);
    std::string body(1, bytes[at]);
    body += bytes.substr(at + 3, length);
    append(file, static_cast<std::uint32_t>(length));
    file += body;
    append(file, record_checksum(body));
    at += 3 + length;
  }
  return file;
}

/// Writes again what was read.
struct Copy {
  RecordWriter& writer;
  void operator()(const RecordedNote& e) { writer.note(e.text); }
  void operator()(const RecordedSubmit& e) { writer.submit(e.now, e.deadline, e.setpoints, e.answer); }
  void operator()(const AxisState& e) { writer.state(e); }
  void operator()(const LoadReading& e) { writer.load(e); }
  void operator()(const RecordedWait& e) { writer.wait(e.now, e.until, e.ended, e.answer); }
  void operator()(const RecordedUrgent& e) { writer.urgent(e.now, e.command, e.answer); }
  void operator()(const RecordedOutputs& e) { writer.outputs(e.now, e.outputs, e.deadline, e.answer); }
  void operator()(const RecordedFrame& e) { writer.frame(e.now, e.asked, e.deadline, e.answer, e.frame); }
};

void check_frame(const RecordedFrame& frame) {
  if (frame.answer != Status::ok) return;
  const Region& region = frame.frame.image.region;
  require(region.width >= 0 && region.height >= 0, "a picture of negative size");
  require(frame.frame.image.pixels.size() ==
              static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height),
          "a picture whose pixels are not its region's");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("port.record"), copied("copied.record");
  const std::string bytes = fuzz::framed(fuzz::text_of(data, size));
  const std::string file = input.fill(bytes).string();
  std::vector<machine::RecordedEntry> entries;
  machine::RecordEnd end;
  const auto keep = [&entries](const machine::RecordedEntry& entry) { entries.push_back(entry); };
  if (!fuzz::accepts(size, file, [&] { end = machine::read_record(file, keep); })) return 0;
  fuzz::require(end.axes >= 1 && end.axes <= machine::kMaxAxes, "a number of axes that no machine has");
  fuzz::require(end.size <= bytes.size() && end.whole == (end.size == bytes.size()),
                "the end of the last whole entry is none");
  std::filesystem::remove(copied.path());
  {
    machine::RecordWriter writer(copied.path(), end.axes);
    for (const machine::RecordedEntry& entry : entries) {
      if (const auto* frame = std::get_if<machine::RecordedFrame>(&entry)) fuzz::check_frame(*frame);
      std::visit(fuzz::Copy{writer}, entry);
    }
    writer.flush();
  }
  std::size_t again = 0;
  const machine::RecordEnd copy =
      machine::read_record(copied.path(), [&again](const machine::RecordedEntry&) { ++again; });
  fuzz::require(copy.whole && again == entries.size(), "what was written again is not read again");
  return 0;
}
