// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/scenario.h"

#include <gtest/gtest.h>

#include <set>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/scenario_file.h"
#include "vantage/session/suggest.h"

namespace vantage {
namespace {

class Scenarios : public testing::Test {
 protected:
  Scenarios() : folder_(std::filesystem::path(testing::TempDir()) / ("vantage_scenario_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Scenarios() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& text) {
    write_file(folder_ / "a.toml", text);
    return (folder_ / "a.toml").string();
  }
  std::filesystem::path folder_;
};

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST_F(Scenarios, EveryOptionHasOneNameAndADescription) {
  Scenario scenario;
  std::set<std::string> names;
  for (const Option& option : list_options(scenario)) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_FALSE(option.doc.empty()) << option.name;
  }
  for (const char* stage : {"scene.", "explore.", "sensor.", "surface.", "visibility.", "planner."})
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name.starts_with(stage); })) << stage;
}

/// Whatever the options are, the file brings them back to the last digit.
TEST_F(Scenarios, TheFileBringsEveryOptionBack) {
  Scenario scenario;
  scenario.scene = "planar";
  scenario.start = {1.0, -0.1};
  int i = 0;
  for (Option& option : list_options(scenario)) {
    if (option.name == "explore.grid") continue;
    if (auto* real = std::get_if<double*>(&option.value); real != nullptr && option.range.low < 0.1 && option.range.high > 0.2)
      **real = 0.1 + 0.001 * ++i;
    if (auto* flag = std::get_if<bool*>(&option.value)) **flag = !**flag;
    if (auto* choice = std::get_if<Option::Choice>(&option.value)) choice->set(static_cast<int>(choice->names.size()) - 1);
  }
  for (const bool documented : {false, true}) {
    Scenario read;
    for (const Setting& setting : read_scenario(file(scenario_as_toml(scenario, documented)))) apply(read, setting);
    EXPECT_EQ(differences(scenario, read), std::vector<std::string>{});
    EXPECT_EQ(scenario_as_toml(read, documented), scenario_as_toml(scenario, documented));
  }
  EXPECT_GT(i, 5);
}

TEST_F(Scenarios, DefaultsOfTheSceneThenFileThenSettings) {
  const World plain = make_world("planar", {});
  const auto& scene = std::get<Scene<2>>(plain.scene);
  EXPECT_EQ(plain.scenario.explore.voxel, scene.voxel);
  EXPECT_EQ(plain.scenario.explore.surface.eta, scene.eta);
  EXPECT_EQ(plain.scenario.sensor.pattern.max_range, scene.range);
  EXPECT_EQ(plain.scenario.start, (std::vector<double>{scene.start[0], scene.start[1]}));
  const std::string path = file("[scene]\nname = \"planar\"\nstart = [3, 4.5]\n[surface]\neta = 0.2\nmin_points = 7\n");
  const Setting setting{"surface.eta", "0.3", "--eta"};
  const World world = make_world(path, std::span(&setting, 1));
  EXPECT_EQ(world.scenario.explore.surface.eta, 0.3);
  EXPECT_EQ(world.scenario.explore.surface.min_points, 7);
  EXPECT_EQ(world.scenario.start, (std::vector<double>{3.0, 4.5}));
}

TEST_F(Scenarios, TheLaterOfGridAndVoxelCounts) {
  const auto voxel = [](std::vector<Setting> settings) { return make_world("planar", settings).scenario.explore.voxel; };
  const double side = std::get<Scene<2>>(make_world("planar", {}).scene).domain.size().maxCoeff();
  EXPECT_DOUBLE_EQ(voxel({{"explore.voxel", "0.3", ""}, {"explore.grid", "50", ""}}), side / 50.0);
  EXPECT_EQ(voxel({{"explore.grid", "50", ""}, {"explore.voxel", "0.3", ""}}), 0.3);
}

TEST_F(Scenarios, MessagesNameThePlaceAndTheNearestName) {
  const std::pair<std::string, std::string> table[] = {
      {"[surface]\netta = 1\n", "a.toml:2: surface.etta: no such option: did you mean surface.eta?"},
      {"\n[surface]\n\neta = -1\n", "a.toml:4: surface.eta = -1: must be"},
      {"[surface]\neta = \"high\"\n", "a.toml:2: surface.eta = high: must be"},
      {"[planner]\nmetric = \"rays\"\n", "must be ray | boundary"},
      {"[surface]\neta = {a = 1}\n", "a.toml:2: surface.eta: must be a number"},
      {"eta = 1\n", "a.toml:1: eta: must stand in a table"},
      {"[scene]\nstart = [1]\n", "scene.start = 1: must be"},
      {"[scene\n", "a.toml:1"},
      {"[surface]\neta = 0.1\n", "no scene is named"},
  };
  for (const auto& [text, message] : table) {
    const std::string found = message_of([&] { static_cast<void>(make_world(file(text), {})); });
    EXPECT_NE(found.find(message), std::string::npos) << found << "\nexpected: " << message;
  }
}

TEST(Suggest, FindsSlipsAndNothingFarFetched) {
  const std::vector<std::string> names{"explore", "scan", "reconstruct", "info"};
  EXPECT_EQ(nearest_name("exlpore", names), "explore");
  EXPECT_EQ(nearest_name("recontruct", names), "reconstruct");
  EXPECT_EQ(nearest_name("scna", names), "scan");
  EXPECT_EQ(nearest_name("banana", names), "");
  EXPECT_EQ(did_you_mean("inof", names), ": did you mean info?");
  EXPECT_EQ(did_you_mean(std::string(1000, 'x'), names), "");
}

}  // namespace
}  // namespace vantage
