// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "vantage/base/error.h"

namespace vantage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& temporary) {
  const std::string reason = std::strerror(errno);
  if (!temporary.empty()) ::unlink(temporary.c_str());
  throw Error(ErrorCode::io, "cannot be written: " + reason, path.string());
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  if (std::filesystem::is_directory(path)) throw Error(ErrorCode::io, "cannot be written: is a folder", path.string());
  const std::string temporary = path.string() + ".part" + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(path, "");
  const bool good = write_all(file, bytes) && ::fsync(file) == 0;
  if (::close(file) != 0 || !good || ::rename(temporary.c_str(), path.c_str()) != 0) fail(path, temporary);
}

}  // namespace vantage
