// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/bytes.h"

#include <zlib.h>

namespace vantage {

std::uint32_t checksum(std::string_view bytes, std::uint32_t start) {
  return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace vantage
