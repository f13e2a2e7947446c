// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// All bytes of a file. Throws io when it is missing, a folder or cannot be read, memory when it does not fit.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Writes beside `path` under another name, flushes to the disk and renames: the file appears whole or not at all, and an old one stays until
/// then. Throws io, leaving nothing behind.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vantage
