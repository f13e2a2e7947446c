// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace vantage {

/// A set of the data that lies outside the project: below $VANTAGE_DATA, else beside the checkout.
inline std::filesystem::path data_set(const std::string& name) {
  const char* folder = std::getenv("VANTAGE_DATA");
  return std::filesystem::path(folder ? folder : VANTAGE_DATA_DEFAULT) / name;
}

/// Leaves the test, skipped, when the set is not there.
#define VANTAGE_NEEDS_DATA(name) \
  if (!std::filesystem::exists(::vantage::data_set(name))) GTEST_SKIP() << "data set '" << (name) << "' is missing: set VANTAGE_DATA"

/// Folder that vanishes with the test.
class ScratchFolder {
 public:
  ScratchFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() / ("vantage-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The text with the first `from` exchanged, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace vantage
