// SPDX-License-Identifier: Apache-2.0
// Fields that leave the program: .vti read again, .npy, OctoMap .bt.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <zlib.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/npy.h"
#include "vantage/io/octomap.h"
#include "vantage/io/test_data.h"
#include "vantage/io/vdb.h"
#include "vantage/io/vti.h"

namespace vantage {
namespace {

template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << error.what();
    return error.what();
  }
  return "";
}

std::string small_vti() {
  const Grid<3> window{0.5, {-4, 2, 0}, {3, 4, 5}};
  const std::vector<float> psi(window.size(), 0.25F);
  const std::vector<std::uint8_t> state(window.size(), 1);
  const ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
  return image_as_vti<3>(window, arrays);
}

TEST(VtiReader, GivesTheFieldBack) {
  rc::check([] {
    const Index<3> extent(*rc::gen::inRange(1, 90), *rc::gen::inRange(1, 90), *rc::gen::inRange(1, 40));
    const Index<3> first(*rc::gen::inRange(-100000, 100000), 3, -7);
    const Grid<3> window{*rc::gen::element(0.1, 0.25, 1.0, 1.0 / 3.0), first, extent};
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<float> psi(window.size());
    std::vector<std::uint8_t> state(window.size());
    for (std::size_t i = 0; i < psi.size(); ++i) {
      psi[i] = static_cast<float>(random.below(1000));
      state[i] = static_cast<std::uint8_t>(random.below(3));
    }
    const ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
    const LatticeImage image = parse_vti(image_as_vti<3>(window, arrays), "a.vti");
    RC_ASSERT(image.window == window);
    RC_ASSERT(image.arrays.size() == 2U);
    RC_ASSERT(image.arrays[0].name == "state");
    RC_ASSERT(std::get<0>(image.arrays[0].values) == state);
    RC_ASSERT(std::get<1>(image.arrays[1].values) == psi);
  });
}

TEST(Vdb, GivesTheFieldBack) {
  if (!has_openvdb()) {
    EXPECT_NE(error_of([] { (void)array_as_vdb({"psi", std::vector<float>(1)}, {0.5, {0, 0, 0}, {1, 1, 1}}); }).find("no OpenVDB"),
              std::string::npos);
    GTEST_SKIP() << "no OpenVDB";
  }
  const Grid<3> window{0.25, {-40, 2, 1}, {21, 14, 9}};
  Random random(5);
  std::vector<float> psi(window.size());
  std::vector<std::uint8_t> state(window.size());
  for (std::size_t i = 0; i < psi.size(); ++i) {
    psi[i] = random.uniform(0.0, 1.0) < 0.3 ? 0.0F : static_cast<float>(random.uniform(-9.0, 9.0));
    state[i] = static_cast<std::uint8_t>(random.below(3));
  }
  psi.front() = psi.back() = 1.0F;  // The window of what is not 0 is the whole.
  state.front() = state.back() = 2;
  const std::string floats = array_as_vdb({"psi", psi}, window), whole = array_as_vdb({"state", state}, window);
  EXPECT_EQ(array_as_vdb({"psi", psi}, window), floats);
  const LatticeImage image = parse_vdb(floats), states = parse_vdb(whole);
  EXPECT_TRUE(image.window == window);
  EXPECT_EQ(image.arrays[0].name, "psi");
  EXPECT_EQ(std::get<1>(image.arrays[0].values), psi);
  EXPECT_EQ(std::get<0>(states.arrays[0].values), state);
}

TEST(VtiReader, RefusesWhatItCannotTrust) {
  const std::string good = small_vti();
  ASSERT_EQ(parse_vti(good, "a.vti").arrays.size(), 2U);
  const auto fails = [](const std::string& bytes) { return error_of([&] { (void)parse_vti(bytes, "a.vti"); }); };
  const std::pair<std::string, std::string> table[] = {
      {replaced(good, "WholeExtent=\"0 2 ", "WholeExtent=\"0 2000000000 "), "nodes along an axis"},
      {replaced(good, "WholeExtent=\"0 2 0 3 0 4\"", "WholeExtent=\"0 999999999 0 999999999 0 999999999\""), "is too large"},
      {replaced(good, "WholeExtent=\"0 2 0 3 0 4\"", "WholeExtent=\"0 9999 0 9999 0 9999\""), "do not hold 1000000000000 bytes"},
      {replaced(good, "WholeExtent=\"0 2 ", "WholeExtent=\"nan 2 "), "WholeExtent"},
      {replaced(good, "Spacing=\"0.5 0.5", "Spacing=\"0.5 0.6"), "Spacing 0.5 0.6 0.5"},
      {replaced(good, "Origin=\"-2 ", "Origin=\"-2.1 "), "multiples of the spacing"},
      {replaced(good, "UInt64", "UInt32"), "header_type"},
      {replaced(good, "LittleEndian", "BigEndian"), "byte_order"},
      {replaced(good, "vtkZLib", "vtkLZ4"), "compressor"},
      {replaced(good, "encoding=\"raw\"", "encoding=\"base64\""), "must be encoded raw"},
      {replaced(good, "Float32", "Float64"), "array psi, Float64 appended: only UInt8 and Float32"},
      {replaced(good, "offset=\"0\"", "offset=\"18446744073709551615\""), "offset 18446744073709551615 exceeds the file"},
      {good.substr(0, good.size() - 70), "exceed the file"},
      {good.substr(0, good.find("<AppendedData")), "not a VTK image"},
      {good.substr(0, good.find("<AppendedData")) + "</VTKFile>", "no AppendedData"}};
  for (const auto& [bytes, message] : table) EXPECT_NE(fails(bytes).find(message), std::string::npos) << message << ": " << fails(bytes);
}

TEST(VtiReader, MutatedFilesLoadOrThrowOneLine) {
  const std::string good = small_vti();
  Random random(7);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bad = good;
    for (std::uint64_t k = 0; k <= random.below(3); ++k) bad[random.below(bad.size())] = static_cast<char>(random.below(256));
    if (i % 5 == 0) bad.resize(random.below(bad.size()));
    const std::string error = error_of([&] { (void)parse_vti(bad, "a.vti"); });
    refused += !error.empty();
    ASSERT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_GT(refused, 1000);
}

TEST(Npy, IsAHeaderOfWholeBlocksAndTheValuesInOrder) {
  const std::int64_t nodes[] = {2, 3, 1};
  const std::string npy = array_as_npy({"psi", std::vector<float>{0, 1, 2, 3, 4, 5}}, nodes);
  ASSERT_EQ(npy.size(), 128U + 6 * sizeof(float));
  EXPECT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
  EXPECT_EQ(get<std::uint16_t>(npy, 8), 118);
  EXPECT_TRUE(npy.substr(10).starts_with("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3, 1), } "));
  EXPECT_EQ(npy[127], '\n');
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(get<float>(npy, 128 + 4 * i), static_cast<float>(i));
  EXPECT_EQ(describe_npy(npy, "a.npy"), "'<f4', (2, 3, 1)");
  EXPECT_EQ(describe_npy(array_as_npy({"state", std::vector<std::uint8_t>(6, 1)}, nodes), "a.npy"), "'|u1', (2, 3, 1)");
}

TEST(Npy, RefusesOtherFilesAndSizes) {
  const std::int64_t nodes[] = {2, 3, 1};
  EXPECT_NE(error_of([&] { (void)array_as_npy({"psi", std::vector<float>(5)}, nodes); }).find("5 values for 6 nodes"), std::string::npos);
  const std::string npy = array_as_npy({"psi", std::vector<float>(6)}, nodes);
  for (const std::string& bytes : {std::string(), std::string("hello"), npy.substr(0, 11), npy.substr(0, 60), replaced(npy, "shape", "snape")})
    EXPECT_NE(error_of([&] { (void)describe_npy(bytes, "a.npy"); }), "") << bytes;
}

/// State of the cube that holds `p`.
NodeState state_at(const OccupancyTree& tree, const Vec<3>& p) {
  for (const OccupancyTree::Leaf& leaf : tree.leaves)
    if ((p - leaf.centre).cwiseAbs().maxCoeff() < 0.5 * leaf.side) return leaf.occupied ? NodeState::obstacle : NodeState::seen;
  return NodeState::unseen;
}

template <int Dim>
Vec<3> in_space(const Vec<Dim>& p) {
  Vec<3> q = Vec<3>::Zero();
  q.head<Dim>() = p;
  return q;
}

template <class Dimension>
class OctomapWriter : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(OctomapWriter, Dimensions);

TYPED_TEST(OctomapWriter, EveryCubeAroundANodeHasItsState) {
  constexpr int Dim = TypeParam::value;
  rc::check([] {
    Index<Dim> first, extent;
    for (int a = 0; a < Dim; ++a) {
      first[a] = *rc::gen::inRange(-9, 9);
      extent[a] = *rc::gen::inRange(1, 6);
    }
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const std::uint64_t kinds = 1 + random.below(3);  // Also fields of one state.
    Field<Dim, NodeState> states(Grid<Dim>{0.4, first, extent});
    for (NodeState& state : states.values) state = static_cast<NodeState>(random.below(kinds));
    const std::string bytes = states_as_octomap<Dim>(states);
    const OccupancyTree tree = parse_occupancy_tree({bytes, "a.bt"});
    RC_ASSERT(tree.resolution == 0.2);
    double volume = 0.0, expected = 0.0;
    for (const OccupancyTree::Leaf& leaf : tree.leaves) volume += leaf.side * leaf.side * leaf.side;
    for (std::size_t i = 0; i < states.values.size(); ++i) {
      expected += states[i] == NodeState::unseen ? 0.0 : 0.4 * 0.4 * 0.4;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec<3> offset(corner & 1 ? 0.1 : -0.1, corner & 2 ? 0.1 : -0.1, corner & 4 ? 0.1 : -0.1);
        RC_ASSERT(state_at(tree, in_space<Dim>(states.window.position(i)) + offset) == states[i]);
      }
    }
    RC_ASSERT(std::abs(volume - expected) < 1e-9);  // And nothing else is known.
  });
}

TEST(Octomap, EqualCubesAreJoined) {
  Field<3, NodeState> states(Grid<3>{1.0, {1, 1, 1}, {64, 64, 64}}, NodeState::seen);
  EXPECT_LT(states_as_octomap<3>(states).size(), 100000U);  // Of 2 M cubes, four bits each.
}

TEST(Octomap, RefusesALatticeBeyondItsReach) {
  const Field<3, NodeState> far(Grid<3>{0.1, {16384, 0, 0}, {1, 1, 1}}, NodeState::seen);
  const Field<3, NodeState> near(Grid<3>{0.1, {16383, -16383, 0}, {1, 1, 1}}, NodeState::seen);
  EXPECT_NE(error_of([&] { (void)states_as_octomap<3>(far); }).find("32768"), std::string::npos);
  EXPECT_EQ(parse_occupancy_tree({states_as_octomap<3>(near), "a.bt"}).leaves.size(), 8U);
}

}  // namespace
}  // namespace vantage
