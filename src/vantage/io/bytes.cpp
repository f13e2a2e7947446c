// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/bytes.h"

#include <zlib.h>

#include <cerrno>
#include <fstream>

#include "vantage/base/error.h"

namespace vantage {

std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw Error(ErrorCode::io, "no such file", path.string());
  if (status.type() == std::filesystem::file_type::directory) throw Error(ErrorCode::io, "is a folder, not a file", path.string());
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), path.string());
  std::string bytes;
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > 0) {  // Ordinary file; a pipe has no size.
    require_memory(static_cast<double>(size), 1.0, path.string());
    bytes.resize(size);
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
  } else {
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (file.bad()) throw Error(ErrorCode::io, "cannot be read", path.string());
  return bytes;
}

std::uint32_t checksum(std::string_view bytes, std::uint32_t start) {
  return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace vantage
