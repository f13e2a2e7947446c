// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// The bytes of a file that only grows, open in one process at a time to write and in any number to read. All functions throw io, naming the file
/// and the system's reason.
class LogFile {
 public:
  enum class Access {
    read,
    write,  ///< Of a file that is there.
    create  ///< And make it if it is not.
  };
  /// Throws io also when another process holds the file to write, naming its number where the system tells it.
  LogFile(std::filesystem::path path, Access access);
  ~LogFile();
  LogFile(LogFile&& other) noexcept;
  LogFile& operator=(LogFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const;
  /// Fewer bytes than `length` where the file ends.
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t length) const;
  /// Puts `bytes` at the file's end `offset` and returns once they are on the disk. On an error the file is cut back; where even that fails, a part
  /// of `bytes` stays behind the end.
  void append(std::uint64_t offset, std::string_view bytes);
  /// Ends the file at `size`, on the disk.
  void cut(std::uint64_t size);
  /// Returns once the file and its name in the folder are on the disk.
  void sync() const;

 private:
  void open(Access access);
  void lock() const;
  [[nodiscard]] bool is_at_its_path() const;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace vantage
