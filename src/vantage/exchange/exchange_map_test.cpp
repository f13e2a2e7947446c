// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/exchange_map.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "vantage/base/error.h"
#include "vantage/exchange/publisher.h"
#include "vantage/exchange/test_clouds.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

/// What three vehicles publish.
const std::vector<Delta>& deltas() {
  static const std::vector<Delta> all = [] {
    std::vector<Delta> out;
    for (const char* source : {"bus", "car", "drone"}) {
      Publisher<3> publisher(source, 0.3);
      for (std::uint64_t scan = 0; scan < 3; ++scan)
        out.push_back(
            publisher.publish(corner_scan<3>(60, Vec<3>::Constant(0.4 * static_cast<double>(scan)), scan + 7 * static_cast<std::uint64_t>(*source))));
    }
    return out;
  }();
  return all;
}

ExchangeMap map_of(const std::vector<std::size_t>& numbers) {
  ExchangeMap map;
  for (const std::size_t n : numbers) map.add(deltas()[n % deltas().size()]);
  return map;
}

ExchangeMap merged(ExchangeMap a, const ExchangeMap& b) {
  a.merge(b);
  return a;
}

using Numbers = std::vector<std::size_t>;

RC_GTEST_PROP(ExchangeMap, MergingIsAUnionOfSets, (const Numbers& x, const Numbers& y, const Numbers& z)) {
  const ExchangeMap a = map_of(x), b = map_of(y), c = map_of(z);
  RC_ASSERT(merged(a, b).bytes() == merged(b, a).bytes());
  RC_ASSERT(merged(merged(a, b), c).bytes() == merged(a, merged(b, c)).bytes());
  RC_ASSERT(merged(a, a).bytes() == a.bytes());
  RC_ASSERT(merged(a, ExchangeMap()).bytes() == a.bytes());
  RC_ASSERT(merged(a, b.without(a)).hash() == merged(a, b).hash());
  RC_ASSERT(a.without(a).empty());
  Numbers both = x;
  both.insert(both.end(), y.begin(), y.end());
  RC_ASSERT(map_of(both).bytes() == merged(a, b).bytes());
}

/// Vehicles meet in any order, send all, only what the other lacks, or only the newest delta, lose some, and hear others twice. When the news has
/// gone round, all hold the same bytes.
RC_GTEST_PROP(ExchangeMap, AnySequenceOfExchangesEndsInEqualHashes, (const std::vector<std::array<std::uint8_t, 4>>& meetings)) {
  std::vector<ExchangeMap> vehicles = {map_of({0, 1, 2}), map_of({3, 4, 5}), map_of({6, 7, 8})};
  for (const auto& [from, to, how, which] : meetings) {
    const ExchangeMap sender = vehicles[from % 3U];
    ExchangeMap& receiver = vehicles[to % 3U];
    if (how % 4 == 0) receiver.merge(sender);
    if (how % 4 == 1) receiver.merge(parse_map(sender.without(receiver).bytes(), "radio"));
    if (how % 4 == 2) receiver.add(sender.entries()[which % sender.entries().size()].delta);
  }
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}, {0, 1}}) {
    vehicles[a].merge(vehicles[b]);
    vehicles[b].merge(vehicles[a]);
  }
  RC_ASSERT(vehicles[0].hash() == vehicles[1].hash());
  RC_ASSERT(vehicles[1].hash() == vehicles[2].hash());
  RC_ASSERT(vehicles[0].hash() == map_of({8, 7, 6, 5, 4, 3, 2, 1, 0}).hash());
}

TEST(ExchangeMap, ReadsBackByteForByte) {
  const ExchangeMap map = map_of({2, 4, 0, 8});
  const std::string bytes = map.bytes();
  const ExchangeMap again = parse_map(bytes, "a.vmap");
  EXPECT_EQ(again.bytes(), bytes);
  ASSERT_EQ(again.entries().size(), 4U);
  const Delta &in = deltas()[0], &out = again.entries()[0].delta;
  EXPECT_EQ(out.source, "bus");
  EXPECT_EQ(out.number, in.number);
  EXPECT_EQ(out.tolerance, 0.3);
  EXPECT_EQ(out.points, in.points);
  EXPECT_EQ(out.bounds.low, in.bounds.low);
  EXPECT_EQ(decoded<3>(out, "a"), decoded<3>(in, "b"));
  EXPECT_EQ(parse_map(ExchangeMap().bytes(), "empty").bytes(), ExchangeMap().bytes());
}

/// The message names the file and an offset in it.
void expect_refused(const std::string& bytes) {
  try {
    static_cast<void>(parse_map(bytes, "a.vmap"));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    ASSERT_TRUE(error.where().starts_with("a.vmap:")) << error.where();
    EXPECT_LE(std::stoull(error.where().substr(7)), bytes.size());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(ExchangeMap, EveryByteMattersAndEveryTruncationIsNoticed) {
  const std::string bytes = map_of({0, 5}).bytes();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int flip : {1, 0x80, 0xff}) {
      std::string wrong = bytes;
      wrong[i] = static_cast<char>(wrong[i] ^ flip);
      expect_refused(wrong);
    }
    expect_refused(bytes.substr(0, i));
  }
  expect_refused(bytes + "x");
}

/// A file with right checksums around any deltas' bytes.
std::string framed(const std::vector<std::string>& bodies, std::uint32_t count) {
  std::string out(kMapMagic);
  put<std::uint32_t>(out, count);
  put<std::uint32_t>(out, checksum(out));
  for (const std::string& body : bodies) {
    std::string frame;
    put<std::uint32_t>(frame, static_cast<std::uint32_t>(body.size()));
    frame += body;
    out += frame;
    put<std::uint32_t>(out, checksum(frame));
  }
  return out;
}

TEST(ExchangeMap, RightChecksumsAroundWrongContent) {
  const std::string a = delta_bytes(deltas()[0]), b = delta_bytes(deltas()[1]);
  EXPECT_NO_THROW(static_cast<void>(parse_map(framed({a, b}, 2), "a.vmap")));
  expect_refused(framed({b, a}, 2));  // Out of order: no other bytes for the same set.
  expect_refused(framed({a, a}, 2));
  expect_refused(framed({a, b}, 1));
  expect_refused(framed({a, b}, 3));
  expect_refused(framed({}, 0xffffffffU));
  expect_refused(framed({""}, 1));
  for (std::size_t size = 0; size < a.size() - deltas()[0].code.size(); ++size) expect_refused(framed({a.substr(0, size)}, 1));
  const std::size_t fields = 1 + 1 + 3 + 4;
  for (const std::size_t offset : {std::size_t{0}, std::size_t{1}, std::size_t{2}, fields + 7, fields + 15, fields + 23, fields + 31, fields + 47}) {
    std::string wrong = a;
    wrong[offset] = '\xff';
    expect_refused(framed({wrong}, 1));
  }
}

TEST(ExchangeMap, AWrongCodeIsNamedByItsOffset) {
  std::string wrong = delta_bytes(deltas()[1]);
  wrong.resize(wrong.size() - deltas()[1].code.size() / 2);
  const ExchangeMap map = parse_map(framed({delta_bytes(deltas()[0]), wrong}, 2), "a.vmap");
  const std::size_t offset = 16 + 4 + delta_bytes(deltas()[0]).size() + 4 + 4;
  try {
    static_cast<void>(map_patches<3>(map, "a.vmap"));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(error.where(), "a.vmap:" + std::to_string(offset));
  }
}

TEST(ExchangeMap, PlaneAndSpaceDoNotMix) {
  ExchangeMap map = map_of({0});
  const Delta flat = Publisher<2>("car", 0.3).publish(corner_scan<2>(50, Vec<2>::Zero(), 1));
  EXPECT_THROW(map.add(flat), Error);
  ExchangeMap plane;
  EXPECT_TRUE(plane.add(flat));
  EXPECT_EQ(parse_map(plane.bytes(), "a").entries()[0].delta.bounds.low, flat.bounds.low);
  EXPECT_THROW(static_cast<void>(map_patches<3>(plane, "a")), Error);
  EXPECT_FALSE(map_patches<2>(plane, "a").empty());
}

TEST(ExchangeMap, TheCertificateTellsWhatIsMissing) {
  EXPECT_EQ(certificate(map_of({0, 1, 2})).missing, 0U);
  EXPECT_EQ(certificate(map_of({0, 2, 5})).missing, 3U);
  EXPECT_EQ(certificate(map_of({0, 1})).data_to_surface, std::max(deltas()[0].data_to_surface, deltas()[1].data_to_surface));
}

TEST(ExchangeMap, APatchThatTwoVehiclesSendIsThereOnce) {
  const auto points = corner_scan<3>(400, Vec<3>::Zero(), 1);
  ExchangeMap one, both;
  one.add(Publisher<3>("car", 0.3).publish(points));
  both.merge(one);
  both.add(Publisher<3>("bus", 0.3).publish(points));
  EXPECT_EQ(both.entries().size(), 2U);
  EXPECT_EQ(map_patches<3>(both, "a").size(), map_patches<3>(one, "a").size());
}

}  // namespace
}  // namespace vantage
