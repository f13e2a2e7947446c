// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

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

/// A name in the same folder that no other call of any process uses.
std::string unused_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> calls{0};
  return path.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(++calls) + ".part";
}

/// Fewer page faults for what lies in whole large pages; systems without them ignore it.
void prefer_large_pages(char* bytes, std::size_t size) {
  constexpr std::uintptr_t kLarge = std::uintptr_t{1} << 21;
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(bytes) + kLarge - 1) & ~(kLarge - 1);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(bytes) + size) & ~(kLarge - 1);
  if (begin < end) (void)::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

void sync_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const File opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() >= 0) ::fsync(opened.get());  // Some file systems refuse; the content is safe already.
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
  const std::string name = unused_name(path);
  File file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) fail(path, "cannot write");
  Leftover leftover{name};
  write_all(file.get(), bytes, path);
  if (::fsync(file.get()) != 0 || !file.close()) fail(path, "cannot write");
  if (::rename(name.c_str(), path.c_str()) != 0) fail(path, "cannot write");
  leftover.path.clear();
  sync_folder(path);
}

}  // namespace vantage
