// SPDX-License-Identifier: Apache-2.0
// Mutated files of every format load or throw vantage::Error. VANTAGE_MUTATIONS=2000 makes so many of each file instead of 300.
#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/image.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/mutations.h"
#include "vantage/io/npy.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/scan_file.h"
#include "vantage/io/vti.h"

namespace vantage {
namespace {

constexpr std::size_t kMostPointsPerByte = 64;  // Of what a file of so few bytes may give: the packed formats stay below.

/// Loads or throws Error, with one line; returns whether it loaded.
bool conforms(const std::string& bytes, const std::string& name) {
  try {
    std::size_t points = 0;
    for (const MeasuredScan& scan : parse_scan_file(bytes, name)) {
      points += scan.points.size();
      for (const Vec<3>& p : scan.points) EXPECT_TRUE(p.allFinite()) << name;
      if (!scan.rays) continue;
      EXPECT_EQ(scan.rays->point.size(), static_cast<std::size_t>(scan.rays->columns) * static_cast<std::size_t>(scan.rays->rows)) << name;
      for (const std::int32_t ray : scan.rays->point) EXPECT_TRUE(ray >= -2 && ray < static_cast<std::int64_t>(scan.points.size())) << name;
    }
    EXPECT_LE(points, kMostPointsPerByte * bytes.size()) << name;
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << name << ": " << error.what();
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << name << ": " << error.what();
    return false;
  }
}

TEST(MutatedScans, LoadOrThrowOneLine) {
  const int count = mutation_count();
  int file = 0;
  for (const auto& [name, bytes] : samples::all()) {
    ASSERT_TRUE(conforms(bytes, name)) << name;
    Random random(static_cast<std::uint64_t>(++file));
    int loaded = 0;
    for (int i = 0; i < count; ++i) {
      std::string bad = mutated(bytes, random);
      // Half of the E57 files get checksums that hide the change.
      if (name.ends_with(".e57") && i % 2 == 0) bad = samples::e57_resealed(bad);
      ASSERT_NO_THROW(loaded += conforms(bad, name)) << name << ", mutation " << i;
    }
    EXPECT_LT(loaded, count) << name << ": no mutation was noticed";
  }
}

/// The same of a scene.
bool scene_conforms(const std::string& bytes, const std::string& name) {
  try {
    const Mesh<3> mesh = parse_mesh(bytes, name);
    for (const Vec<3>& v : mesh.vertices) EXPECT_TRUE(v.allFinite()) << name;
    for (const auto& facet : mesh.facets)
      for (const std::uint32_t v : facet) EXPECT_LT(v, mesh.vertices.size()) << name;
    EXPECT_LE(mesh.facets.size(), kMostPointsPerByte * bytes.size()) << name;
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << name << ": " << error.what();
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << name << ": " << error.what();
    return false;
  }
}

TEST(MutatedScenes, LoadOrThrowOneLine) {
  const int count = mutation_count();
  int file = 100;
  for (const auto& [name, bytes] : samples::scenes()) {
    ASSERT_TRUE(scene_conforms(bytes, name)) << name;
    Random random(static_cast<std::uint64_t>(++file));
    int loaded = 0;
    for (int i = 0; i < count; ++i) ASSERT_NO_THROW(loaded += scene_conforms(mutated(bytes, random), name)) << name << ", mutation " << i;
    EXPECT_LT(loaded, count) << name << ": no mutation was noticed";
  }
}

std::string small_field() {
  const Grid<3> window{0.5, {-4, 2, 0}, {3, 4, 2}};
  const std::vector<float> psi(window.size(), 0.25F);
  const ImageArray arrays[] = {{"psi", std::span<const float>(psi)}};
  return image_as_vti<3>(window, arrays);
}

TEST(MutatedOthers, LoadOrThrowOneLine) {
  const Patch<3> patches[] = {point_patch<3>({1, 2, 3}), segment_patch<3>({0, 0, 0}, {1, 0, 0})};
  const std::int64_t nodes[] = {3, 2};
  using Reader = std::function<void(const std::string&)>;
  const std::pair<std::string, Reader> readers[] = {
      {small_field(), [](const std::string& bytes) { (void)parse_vti(bytes, "a.vti"); }},
      {array_as_npy({"psi", std::vector<float>(6, 0.5F)}, nodes), [](const std::string& bytes) { (void)describe_npy(bytes, "a.npy"); }},
      {patches_as_ply<3>(patches), [](const std::string& bytes) { (void)parse_patches(bytes, "a.ply"); }},
      {"P2 # a\n2 2\n15\n0 15 7 3\n", [](const std::string& bytes) { (void)parse_gray_image(bytes, "a.pgm", 205); }}};
  std::uint64_t seed = 200;
  for (const auto& [bytes, read] : readers) expect_conforming(bytes, read, ++seed);
}

}  // namespace
}  // namespace vantage
