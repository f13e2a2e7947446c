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

/// Writes beside `path` under another name (`PATH.PROCESS-NUMBER.part`), flushes to the disk and renames: the file appears whole or not at all, and
/// an old one stays until then. Returns once the name is on the disk too. Throws io, leaving nothing under the other name.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Returns once the names in `folder` are on the disk, as far as its file system can do that. Throws io.
void sync_folder(const std::filesystem::path& folder);

/// Removes what write_file of processes that are no more left in `folder`; call before this process writes there. What cannot be removed stays.
void remove_stale_parts(const std::filesystem::path& folder);

}  // namespace vantage
