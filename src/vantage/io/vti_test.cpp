// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/vti.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

/// Decodes an appended array as the VTK file format says.
std::string decoded(std::string_view file, std::size_t offset) {
  const std::string_view data = file.substr(file.find("\n   _") + 5 + offset);
  const auto word = [&](std::size_t i) { return get<std::uint64_t>(data, 8 * i); };
  const std::size_t blocks = word(0), block = word(1), last = word(2);
  std::size_t begin = 8 * (3 + blocks);
  std::string out;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t want = i + 1 == blocks && last != 0 ? last : block;
    std::string part(want, '\0');
    uLongf size = want;
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(part.data()), &size, reinterpret_cast<const Bytef*>(data.data() + begin), word(3 + i)), Z_OK);
    EXPECT_EQ(size, want);
    out += part;
    begin += word(3 + i);
  }
  return out;
}

template <class Number>
std::string raw(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

TEST(Vti, ArraysOfSeveralBlocksComeBack) {
  const Grid<3> window{0.5, {-4, 2, 0}, {100, 120, 30}};  // Floats: two blocks, the second short.
  std::vector<float> psi(window.size());
  std::vector<std::uint8_t> state(window.size());
  for (std::size_t i = 0; i < psi.size(); ++i) {
    psi[i] = static_cast<float>(i) * 0.25F;
    state[i] = static_cast<std::uint8_t>(i % 3);
  }
  const ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
  const std::string file = image_as_vti<3>(window, arrays);
  EXPECT_EQ(decoded(file, 0), raw(state));
  const std::size_t tag = file.find("Name=\"psi\"");
  const std::size_t begin = file.find("offset=\"", tag) + 8;
  EXPECT_EQ(decoded(file, std::stoul(file.substr(begin, file.find('"', begin) - begin))), raw(psi));

  const ImageInfo info = parse_vti_header(file, "a.vti");
  EXPECT_EQ(info.nodes, (std::vector<std::int64_t>{100, 120, 30}));
  EXPECT_EQ(info.origin, (std::vector<double>{-2.0, 1.0, 0.0}));
  EXPECT_EQ(info.spacing, (std::vector<double>{0.5, 0.5, 0.5}));
  ASSERT_EQ(info.arrays.size(), 2U);
  EXPECT_EQ(info.arrays[1].name + " " + info.arrays[1].type, "psi Float32");
}

TEST(Vti, APlaneIsOneLayer) {
  const Grid<2> window{1.0, {3, -1}, {4, 5}};
  const std::vector<float> psi(window.size(), 2.0F);
  const ImageArray arrays[] = {{"psi", std::span<const float>(psi)}};
  const ImageInfo info = parse_vti_header(image_as_vti<2>(window, arrays), "a.vti");
  EXPECT_EQ(info.nodes, (std::vector<std::int64_t>{4, 5, 1}));
  EXPECT_EQ(info.origin, (std::vector<double>{3.0, -1.0, 0.0}));
}

TEST(Vti, RefusesOtherFiles) {
  for (const char* bytes : {"", "hello", "<VTKFile></VTKFile>", "<VTKFile><ImageData WholeExtent=\"0 1\"/></VTKFile>", "<VTKFile"})
    EXPECT_THROW(static_cast<void>(parse_vti_header(bytes, "a.vti")), Error) << bytes;
}

}  // namespace
}  // namespace vantage
