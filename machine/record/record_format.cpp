#include "machine/record/record_format.h"

#include <boost/crc.hpp>

namespace understudy::machine {

std::uint32_t record_checksum(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace understudy::machine
