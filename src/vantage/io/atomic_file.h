// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace vantage {

/// All bytes of a file. Throws io when it is missing, a folder or cannot be read, memory when it does not fit.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// The bytes of a file, for readers of large ones: nothing is copied or cleared.
struct FileBuffer {
  std::unique_ptr<char[]> bytes;
  std::size_t size = 0;
  [[nodiscard]] std::string_view view() const { return {bytes.get(), size}; }
};

/// As read_file.
[[nodiscard]] FileBuffer read_buffer(const std::filesystem::path& path);

/// Writes beside `path` under another name, flushes to the disk and renames: the file appears whole or not at all, and an old one stays until
/// then. Throws io, leaving nothing behind.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vantage
