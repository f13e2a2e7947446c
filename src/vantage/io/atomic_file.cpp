// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "vantage/base/error.h"

namespace vantage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw Error(ErrorCode::io, what + ": " + std::strerror(errno), path.string());
}

class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Removes the file unless it was renamed away.
struct Leftover {
  std::filesystem::path path;
  ~Leftover() {
    if (!path.empty()) ::unlink(path.c_str());
  }
};

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(path, "cannot write");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

constexpr std::string_view kPart = ".part";

/// A new file beside `path` that no other call of any process uses.
std::pair<int, std::string> open_part(const std::filesystem::path& path) {
  static std::atomic<unsigned> calls{0};
  for (;;) {
    const std::string name = path.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(++calls) + std::string(kPart);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) return {file, name};
    if (errno != EEXIST) fail(path, "cannot write");  // Else of a process that is no more and had our number.
  }
}

/// Process that made the file of this name; 0: it is none of open_part.
int maker(std::string_view name) {
  if (!name.ends_with(kPart)) return 0;
  name.remove_suffix(kPart.size());
  const std::size_t dash = name.rfind('-'), dot = name.rfind('.');
  if (dash == std::string_view::npos || dot == std::string_view::npos || dash < dot || dash + 1 == name.size()) return 0;
  if (name.find_first_not_of("0123456789", dash + 1) != std::string_view::npos) return 0;
  int pid = 0;
  const auto [end, error] = std::from_chars(name.data() + dot + 1, name.data() + dash, pid);
  return error == std::errc() && end == name.data() + dash ? pid : 0;
}

/// Fewer page faults for what lies in whole large pages; systems without them ignore it.
void prefer_large_pages(char* bytes, std::size_t size) {
  constexpr std::uintptr_t kLarge = std::uintptr_t{1} << 21;
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(bytes) + kLarge - 1) & ~(kLarge - 1);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(bytes) + size) & ~(kLarge - 1);
  if (begin < end) (void)::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace

FileBuffer read_buffer(const std::filesystem::path& path) {
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail(path, "cannot open");
  struct stat status{};
  if (::fstat(file.get(), &status) != 0) fail(path, "cannot read");
  if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::io, "is a folder, not a file", path.string());
  require_memory(static_cast<double>(status.st_size), 1.0, path.string());
  FileBuffer buffer;
  std::size_t room = static_cast<std::size_t>(status.st_size) + 1;  // One more, to meet the end without growing.
  buffer.bytes = std::make_unique_for_overwrite<char[]>(room);
  prefer_large_pages(buffer.bytes.get(), room);
  for (;;) {  // Until the end, not only the stated size: pipes state none.
    if (buffer.size == room) {
      room = 2 * room + 65536;
      auto wider = std::make_unique_for_overwrite<char[]>(room);
      std::memcpy(wider.get(), buffer.bytes.get(), buffer.size);
      buffer.bytes = std::move(wider);
    }
    const ssize_t n = ::read(file.get(), buffer.bytes.get() + buffer.size, room - buffer.size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot read");
    if (n == 0) return buffer;
    buffer.size += static_cast<std::size_t>(n);
  }
}

std::string read_file(const std::filesystem::path& path) { return std::string(read_buffer(path).view()); }

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const auto [descriptor, name] = open_part(path);
  File file(descriptor);
  Leftover leftover{name};
  write_all(file.get(), bytes, path);
  if (::fsync(file.get()) != 0 || !file.close()) fail(path, "cannot write");
  if (::rename(name.c_str(), path.c_str()) != 0) fail(path, "cannot write");
  leftover.path.clear();
  sync_folder(path.has_parent_path() ? path.parent_path() : ".");
}

void sync_folder(const std::filesystem::path& folder) {
  const File opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() < 0 && errno == EACCES) return;  // One may write there without reading.
  if (opened.get() < 0) fail(folder, "cannot open");
  if (::fsync(opened.get()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(folder, "cannot write");  // These two: it has no such thing.
}

void remove_stale_parts(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> stale;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const int pid = maker(it->path().filename().string());
    if (pid > 0 && (pid == ::getpid() || (::kill(pid, 0) != 0 && errno == ESRCH))) stale.push_back(it->path());
  }
  for (const std::filesystem::path& path : stale) std::filesystem::remove(path, error);
}

}  // namespace vantage
