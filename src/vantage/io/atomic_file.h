// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

namespace vantage {

/// Writes a whole file or nothing: into a temporary file of the same folder, to the disk, then renamed. Throws io.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vantage
