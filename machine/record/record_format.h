// The bytes of a port record (docs/port-record.md): a first line, then entries.
#pragma once

#include <cstdint>
#include <string_view>

namespace understudy::machine {

/// First word of the first line; the number of axes follows.
constexpr std::string_view kRecordMagic = "understudy.port-record/1";

enum class RecordKind : std::uint8_t { note = 1, submit, state, wait, urgent, outputs, frame, load };

constexpr std::size_t kEntryMax = 256'000'000;  ///< [bytes], of one entry: a picture of a large camera

/// CRC-32 as zlib computes it.
std::uint32_t record_checksum(std::string_view bytes);

}  // namespace understudy::machine
