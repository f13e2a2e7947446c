// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iostream>

#include "vantage/base/error.h"
#include "vantage/session/suggest.h"

using vantage::Error;
using vantage::ErrorCode;

namespace {

constexpr std::size_t kHelpColumn = 30, kHelpWidth = 110;

/// Help texts broken between words, with the options in one column.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kHelpColumn); }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string head = "  " + (is_positional ? option->get_name(true) : option->get_name(false, true));
    if (!is_positional && !option->get_type_name().empty()) head += " " + option->get_type_name();
    if (head.size() + 2 > kHelpColumn)
      head += "\n" + std::string(kHelpColumn, ' ');
    else
      head.resize(kHelpColumn, ' ');
    std::string out;
    std::size_t width = 0;
    for (const std::string& word : CLI::detail::split(option->get_description(), ' ')) {
      if (width > 0 && kHelpColumn + width + 1 + word.size() > kHelpWidth) {
        out += "\n" + std::string(kHelpColumn, ' ');
        width = 0;
      }
      out += (width > 0 ? " " : "") + word;
      width += word.size() + 1;
    }
    return head + out + "\n";
  }
  std::string make_usage(const CLI::App*, std::string name) const override { return "usage: " + name + "\n"; }
};

}  // namespace

CommandParser::CommandParser(const std::string& name, const std::string& usage, const std::string& purpose, const std::string& examples)
    : app_(purpose, "vantage " + name + " " + usage) {
  app_.formatter(std::make_shared<HelpFormatter>());
  app_.allow_extras();
  app_.footer("Examples:\n" + examples);
}

CLI::Option* CommandParser::option(const std::string& names, std::string& value, const std::string& type, const std::string& help,
                                   const std::string& group) {
  return app_.add_option(names, value, help)->type_name(type)->take_last()->group(group);
}

CLI::Option* CommandParser::flag(const std::string& names, bool& value, const std::string& help, const std::string& group) {
  return app_.add_flag(names, value, help)->group(group);
}

bool CommandParser::parse(const Arguments& arguments) {
  app_.set_help_flag("-h,--help", "this text")->group("Other");  // Last, so that it stands last.
  try {
    app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    std::string help = app_.help();
    for (std::size_t at = 0; (at = help.find("\n\n\n")) != std::string::npos;) help.erase(at, 1);
    std::cout << help;
    return false;
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::bad_input, error.what());
  }
  for (const std::string& extra : app_.remaining()) {
    if (extra.empty() || extra.front() != '-') continue;
    std::vector<std::string> names;
    for (const CLI::Option* option : app_.get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::string word = extra.substr(0, extra.find('='));
    throw Error(ErrorCode::bad_input, fmt::format("{}: unknown option{}", word, vantage::did_you_mean(word, names)));
  }
  for (const std::string& extra : app_.remaining()) throw Error(ErrorCode::bad_input, fmt::format("{}: not expected here", extra));
  return true;
}

std::int64_t whole_number(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
  vantage::require(good, fmt::format("{}: must be a whole number, {} .. {}", text, low, high), option);
  return value;
}

std::vector<double> numbers(const std::string& option, const std::string& text) {
  std::vector<double> values;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    vantage::require(error == std::errc() && end == part.data() + part.size() && std::isfinite(value),
                     fmt::format("{}: must be numbers between commas", text), option);
    values.push_back(value);
  }
  return values;
}

void set_options(std::vector<vantage::Option> options, const std::string& stage, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    vantage::require(equals != std::string::npos, text + ": must be stage.option=value", "--set");
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    bool found = false;
    for (vantage::Option& option : options) {
      names.push_back(stage + "." + option.name);
      if (names.back() != name) continue;
      option.parse(text.substr(equals + 1), name);
      found = true;
    }
    vantage::require(found, fmt::format("{}: no such option{}", name, vantage::did_you_mean(name, names)), "--set");
  }
}
