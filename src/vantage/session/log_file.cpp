// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/log_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"

namespace vantage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what) {
  throw Error(ErrorCode::io, fmt::format("{}: {}", what, std::strerror(errno)), path.string());
}

/// " (pid 123)" of the process that holds the lock of `file`; nothing where the system does not tell.
std::string holder(int file) {
  struct stat status{};
  if (::fstat(file, &status) != 0) return {};
  const std::string wanted = fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {  // "1: FLOCK  ADVISORY  WRITE 123 fe:00:456 0 EOF"
    std::istringstream words(line);
    std::string number, kind, force, access, pid, place;
    words >> number >> kind >> force >> access >> pid >> place;
    if (kind == "FLOCK" && place == wanted && pid != "0") return fmt::format(" (pid {})", pid);
  }
  return {};
}

bool write_all(int file, std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    offset += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

LogFile::LogFile(std::filesystem::path path, Access access) : path_(std::move(path)) {
  try {
    open(access);
    if (access == Access::read) return;
    for (lock(); !is_at_its_path(); lock()) {  // The one who held it has put another file in its place.
      ::close(std::exchange(file_, -1));
      open(access);
    }
  } catch (...) {
    if (file_ >= 0) ::close(file_);
    throw;
  }
}

LogFile::~LogFile() {
  if (file_ >= 0) ::close(file_);
}

LogFile::LogFile(LogFile&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

void LogFile::open(Access access) {
  const int flags = access == Access::read ? O_RDONLY : access == Access::write ? O_RDWR : O_RDWR | O_CREAT;
  file_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path_, access == Access::create ? "cannot be made" : "cannot be opened");
}

void LogFile::lock() const {
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) fail(path_, "cannot be locked");
  throw Error(ErrorCode::io, fmt::format("another process{} is writing this run", holder(file_)), path_.string());
}

bool LogFile::is_at_its_path() const {
  struct stat mine{}, there{};
  if (::fstat(file_, &mine) != 0) fail(path_, "cannot be read");
  return ::stat(path_.c_str(), &there) == 0 && mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

std::uint64_t LogFile::size() const {
  struct stat status{};
  if (::fstat(file_, &status) != 0) fail(path_, "cannot be read");
  return static_cast<std::uint64_t>(status.st_size);
}

std::string LogFile::read(std::uint64_t offset, std::size_t length) const {
  std::string bytes(length, '\0');
  std::size_t done = 0;
  while (done < length) {
    const ssize_t got = ::pread(file_, bytes.data() + done, length - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_, "cannot be read");
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

void LogFile::append(std::uint64_t offset, std::string_view bytes) {
  if (write_all(file_, offset, bytes) && ::fsync(file_) == 0) return;
  const int reason = errno;
  static_cast<void>(::ftruncate(file_, static_cast<off_t>(offset)));
  errno = reason;
  fail(path_, "cannot be written");
}

void LogFile::cut(std::uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0 || ::fsync(file_) != 0) fail(path_, "cannot be cut");
}

void LogFile::sync() const {
  if (::fsync(file_) != 0) fail(path_, "cannot be written");
  sync_folder(path_.has_parent_path() ? path_.parent_path() : ".");
}

}  // namespace vantage
