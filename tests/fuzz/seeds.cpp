// SPDX-License-Identifier: Apache-2.0
// fuzz_seeds FOLDER: writes FOLDER/ENDING/NAME for every sample scan and scene, and a field.
#include <fmt/format.h>

#include <exception>

#include "vantage/io/atomic_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/vti.h"

namespace {

std::string field() {
  const vantage::Grid<3> window{0.5, {-4, 2, 0}, {3, 4, 2}};
  const std::vector<float> psi(window.size(), 0.25F);
  const std::vector<std::uint8_t> state(window.size(), 1);
  const vantage::ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
  return vantage::image_as_vti<3>(window, arrays);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  try {
    auto files = vantage::samples::all();
    for (const auto& scene : vantage::samples::scenes()) files.push_back(scene);
    files.emplace_back("a.vti", field());
    for (const auto& [name, bytes] : files) {
      const std::filesystem::path folder = std::filesystem::path(arguments[1]) / name.substr(name.rfind('.') + 1);
      std::filesystem::create_directories(folder);
      vantage::write_file(folder / name, bytes);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz_seeds: {}\n", error.what());
    return 1;
  }
  return 0;
}
