// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "commands.h"
#include "vantage/base/options.h"

/// A parser for one command: `purpose` opens its help, `examples` ends it.
class CommandParser {
 public:
  CommandParser(const std::string& name, const std::string& usage, const std::string& purpose, const std::string& examples);

  [[nodiscard]] CLI::App& app() { return app_; }
  /// Takes a value as text; the last one given counts.
  CLI::Option* option(const std::string& names, std::string& value, const std::string& type, const std::string& help, const std::string& group);
  CLI::Option* flag(const std::string& names, bool& value, const std::string& help, const std::string& group);

  /// False if only the help was wanted and has been printed. Throws vantage::Error for anything that was not expected, naming the nearest option.
  [[nodiscard]] bool parse(const Arguments& arguments);

 private:
  CLI::App app_;
};

/// A whole number of an option, checked. Throws bad_input at `option`.
[[nodiscard]] std::int64_t whole_number(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high);
/// Numbers between commas. Throws bad_input at `option`.
[[nodiscard]] std::vector<double> numbers(const std::string& option, const std::string& text);
/// Applies `stage.option=value` texts to the options of one stage. Throws bad_input, naming the nearest option for an unknown one.
void set_options(std::vector<vantage::Option> options, const std::string& stage, const std::vector<std::string>& texts);
