// SPDX-License-Identifier: Apache-2.0
// The short form of the fuzzers for what other modules read: damaged maps, logs, lists of poses, zones, descriptions of maps and scenarios load or
// throw vantage::Error.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "vantage/exchange/publisher.h"
#include "vantage/exchange/sealed_map.h"
#include "vantage/exchange/test_clouds.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/mutations.h"
#include "vantage/io/occupancy_map.h"
#include "vantage/session/poses.h"
#include "vantage/session/scenario_file.h"
#include "vantage/session/sealed_log.h"
#include "vantage/session/zone_file.h"

namespace vantage {
namespace {

template <int Dim>
std::string small_map() {
  ExchangeMap map;
  Publisher<Dim> publisher("a", 0.1);
  for (const std::uint64_t seed : {1, 2}) map.add(publisher.publish(corner_scan<Dim>(40, Vec<Dim>::Zero(), seed)));
  return map.bytes();
}

TEST(Mutated, MapsLoadOrThrowOneLine) {
  expect_conforming(small_map<2>(), [](const std::string& bytes) { (void)map_patches<2>(parse_map(bytes, "a"), "a"); }, 301, samples::resealed_map);
  expect_conforming(small_map<3>(), [](const std::string& bytes) { (void)map_patches<3>(parse_map(bytes, "a"), "a"); }, 302, samples::resealed_map);
}

template <int Dim>
void read_log(const std::filesystem::path& path, const std::string& bytes) {
  write_file(path, bytes);
  const auto log = ScanLog<Dim>::open_to_read(path);
  for (int i = 0; i < log.size(); ++i) (void)log.read(i);
}

TEST(Mutated, LogsLoadOrThrowOneLine) {
  const std::filesystem::path path = testing::TempDir() + "vantage-log-" + std::to_string(::getpid());
  expect_conforming(samples::scan_log<2>(), [&](const std::string& bytes) { read_log<2>(path, bytes); }, 311, samples::resealed_log);
  expect_conforming(samples::scan_log<3>(), [&](const std::string& bytes) { read_log<3>(path, bytes); }, 312, samples::resealed_log);
  std::filesystem::remove(path);
}

TEST(Mutated, TextsLoadOrThrowOneLine) {
  const auto poses = [](const std::string& text) { (void)parse_poses(text, "poses.csv"); };
  expect_conforming("name,tx,ty,tz,qw,qx,qy,qz\na,1,2,3,1,0,0,0\nb,1,2,3,0,1,0,0\n", poses, 321);
  expect_conforming("1 0 0 5 0 1 0 6 0 0 1 7\n", poses, 322);
  expect_conforming("1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n", poses, 323);
  const auto zones = [](const std::string& text) { (void)parse_csv_zones(text, "zones.csv"); };
  expect_conforming("# zone\nid;x;y\na;0;0\na;9;0\na;9;9\n\na;1;1\na;2;1\na;2;2\n", zones, 325);
  const auto geojson = [](const std::string& text) { (void)parse_geojson_zones(text, "zones.json"); };
  expect_conforming(R"({"type":"Polygon","crs":null,"coordinates":[[[0,0],[9,0],[9,99]],[[2,1],[3,1],[3,2]]]})", geojson, 326);
  const auto description = [](const std::string& text) { (void)parse_map_description(text, "map.yaml"); };
  expect_conforming("image: a.png\nresolution: 0.05 # [m]\norigin: [-1, 2.5, 0]\nnegate: 0\nmode: trinary\n", description, 327);
  const auto scenario = [](const std::string& text) { (void)parse_scenario(text, "none/a.toml"); };
  expect_conforming("[scene]\nname = \"pipes\"\nstart = [0.0, 0.0, 1.5]\n[surface]\neta = 0.05 # [m]\n", scenario, 324);
  EXPECT_THROW(scenario("\"a\\nb\" = 1\n"), Error);
  try {
    scenario("\"a\\nb\" = 1\n");
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "none/a.toml:1: a?b: must stand in a table, say [explore]");
  }
}

}  // namespace
}  // namespace vantage
