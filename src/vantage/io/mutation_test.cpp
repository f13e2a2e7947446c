// SPDX-License-Identifier: Apache-2.0
// Mutated files of every format load or throw vantage::Error. VANTAGE_MUTATIONS=2000 makes so many of each file instead of 300.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/scan_file.h"

namespace vantage {
namespace {

constexpr std::size_t kMostPointsPerByte = 64;  // Of what a file of so few bytes may give: the packed formats stay below.

void flip_bit(std::string& bytes, Random& random) {
  const std::size_t at = random.below(bytes.size());
  bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
}

void set_byte(std::string& bytes, Random& random) {
  constexpr char kBytes[] = {'\0', '\1', '\x7f', '\x80', '\xff', '0', '9', '-', '.', 'e', ' ', '\n'};
  bytes[random.below(bytes.size())] = kBytes[random.below(std::size(kBytes))];
}

/// What a size or a count might say.
void set_number(std::string& bytes, Random& random) {
  constexpr std::uint64_t kNumbers[] = {0, 1, 2, 0x7f, 0xff, 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, 0xffffffffffffffff};
  std::string number;
  put(number, kNumbers[random.below(std::size(kNumbers))]);
  const std::size_t width = std::size_t{1} << random.below(4);
  const std::size_t at = random.below(bytes.size());
  bytes.replace(at, std::min(width, bytes.size() - at), number.substr(0, width));
}

/// A number of a text header.
void set_digits(std::string& bytes, Random& random) {
  constexpr const char* kWords[] = {"0", "-1", "nan", "1e999", "4294967296", "18446744073709551615", "99999999999999999999", ""};
  const std::size_t from = bytes.find_first_of("0123456789", random.below(bytes.size()));
  if (from == std::string::npos) return;
  bytes.replace(from, std::min(bytes.find_first_not_of("0123456789", from), bytes.size()) - from, kWords[random.below(std::size(kWords))]);
}

void cut_end(std::string& bytes, Random& random) { bytes.resize(random.below(bytes.size())); }

void move_part(std::string& bytes, Random& random) {
  const std::string part = bytes.substr(random.below(bytes.size()), 1 + random.below(64));
  bytes.insert(random.below(bytes.size()), part);
}

std::string mutated(std::string bytes, Random& random) {
  constexpr void (*kMutations[])(std::string&, Random&) = {flip_bit, set_byte, set_number, set_digits, cut_end, move_part};
  const std::uint64_t changes = 1 + random.below(3);
  for (std::uint64_t k = 0; k < changes && !bytes.empty(); ++k) kMutations[random.below(std::size(kMutations))](bytes, random);
  return bytes;
}

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
  const char* asked = std::getenv("VANTAGE_MUTATIONS");
  const int count = asked ? std::atoi(asked) : 300;
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
  const char* asked = std::getenv("VANTAGE_MUTATIONS");
  const int count = asked ? std::atoi(asked) : 300;
  int file = 100;
  for (const auto& [name, bytes] : samples::scenes()) {
    ASSERT_TRUE(scene_conforms(bytes, name)) << name;
    Random random(static_cast<std::uint64_t>(++file));
    int loaded = 0;
    for (int i = 0; i < count; ++i) ASSERT_NO_THROW(loaded += scene_conforms(mutated(bytes, random), name)) << name << ", mutation " << i;
    EXPECT_LT(loaded, count) << name << ": no mutation was noticed";
  }
}

}  // namespace
}  // namespace vantage
