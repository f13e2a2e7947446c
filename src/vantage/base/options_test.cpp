// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/options.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"

namespace vantage {
namespace {

enum class Metric { ray, boundary };

struct Sample {
  double eta = 0.1;
  std::int64_t depth = 14;
  bool paper = false;
  Metric metric = Metric::ray;
  double step = 0.5 / 57.295779513082320877;
  double cap = std::numeric_limits<double>::infinity();
};

void describe(Sample& sample, const OptionVisitor& visit) {
  visit("eta", sample.eta, "m", {1e-6, 10.0}, "tolerance");
  visit("depth", sample.depth, "levels", {0, 24}, "deepest cell");
  visit("paper", sample.paper, "as printed");
  visit("metric", sample.metric, {"ray", "boundary"}, "form of the metric");
  visit.angle("step_deg", sample.step, {0.01, 90.0}, "between rays");
  visit("cap", sample.cap, "m", {0.0}, "largest distance");
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "nothing thrown";
}

Option& find(std::vector<Option>& options, std::string_view name) {
  for (Option& option : options)
    if (option.name == name) return option;
  throw std::logic_error("no such option");
}

TEST(Options, TextOfDefaultsParsesBackToThem) {
  Sample sample;
  for (Option& option : list_options(sample)) {
    const std::string text = option.text();
    option.parse(text, option.name);
    EXPECT_EQ(option.text(), text) << option.name;
  }
  EXPECT_EQ(sample.eta, 0.1);
  EXPECT_NEAR(sample.step, Sample{}.step, 1e-12);
}

TEST(Options, ParseSetsTheField) {
  Sample sample;
  auto options = list_options(sample);
  find(options, "eta").parse("0.25", "surface.eta");
  find(options, "depth").parse("7", "surface.depth");
  find(options, "paper").parse("true", "surface.paper");
  find(options, "metric").parse("boundary", "planner.metric");
  find(options, "step_deg").parse("90", "scan.step_deg");
  EXPECT_EQ(sample.eta, 0.25);
  EXPECT_EQ(sample.depth, 7);
  EXPECT_TRUE(sample.paper);
  EXPECT_EQ(sample.metric, Metric::boundary);
  EXPECT_NEAR(sample.step, 1.5707963267948966, 1e-12);
}

TEST(Options, WhatIsNotAllowedIsNamed) {
  const auto parse = [](std::string_view name, std::string_view text) {
    return message_of([&] {
      Sample sample;
      auto options = list_options(sample);
      find(options, name).parse(text, "stage." + std::string(name));
    });
  };
  for (const std::string_view text : {"-0.1", "0", "11", "nan", "inf", "1e999"}) {
    const std::string message = parse("eta", text);
    EXPECT_NE(message.find("stage.eta = "), std::string::npos) << message;
    EXPECT_NE(message.find("1e-06 .. 10"), std::string::npos) << message;
    EXPECT_NE(message.find("[m]"), std::string::npos) << message;
  }
  for (const std::string_view text : {"", "x", "0.1m", " 0.1", "0,1"}) EXPECT_NE(parse("eta", text), "nothing thrown") << text;
  for (const std::string_view text : {"-1", "25", "3.5", "99999999999999999999"}) EXPECT_NE(parse("depth", text), "nothing thrown") << text;
  for (const std::string_view text : {"yes", "1", "TRUE", ""}) EXPECT_NE(parse("paper", text).find("true | false"), std::string::npos) << text;
  EXPECT_NE(parse("metric", "rays").find("ray | boundary"), std::string::npos);
  for (const std::string_view text : {"0", "91", "-1"}) EXPECT_NE(parse("step_deg", text), "nothing thrown") << text;
}

TEST(Options, CheckFindsFieldsSetByHand) {
  EXPECT_NO_THROW(check_options(Sample{}, "surface"));
  EXPECT_EQ(message_of([] { check_options(Sample{.eta = -0.1}, "surface"); }).find("surface.eta = -0.1"), 0U);
  EXPECT_EQ(message_of([] { check_options(Sample{.depth = 99}, "surface"); }).find("surface.depth = 99"), 0U);
  EXPECT_NE(message_of([] { check_options(Sample{.eta = std::numeric_limits<double>::quiet_NaN()}, "surface"); }), "nothing thrown");
  EXPECT_NE(message_of([] { check_options(Sample{.step = 7.0}, "surface"); }), "nothing thrown");
  EXPECT_NE(message_of([] { check_options(Sample{.cap = -1.0}, "surface"); }), "nothing thrown");
}

TEST(Options, EndsOfARangeAreAllowed) {
  EXPECT_NO_THROW(check_options(Sample{.eta = 1e-6, .depth = 0, .cap = 0.0}, "s"));
  EXPECT_NO_THROW(check_options(Sample{.eta = 10.0, .depth = 24}, "s"));
  Sample sample;
  auto options = list_options(sample);
  find(options, "step_deg").parse("0.01", "s");
  EXPECT_NO_THROW(check_options(sample, "s"));
}

}  // namespace
}  // namespace vantage
