// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace vantage {

/// Closed interval of allowed values.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// Names of an enumeration's values, in order from 0.
using Choices = std::vector<std::string>;

/// One described option: the single source for range checks, files, `--set`, help, docs.
struct Option {
  struct Choice {
    std::function<int()> get;
    std::function<void(int)> set;
    Choices names;
  };
  struct Angle {
    double* radians;  ///< Held in radians, written in degrees.
  };
  std::string name;  ///< `eta`; the stage is the caller's prefix.
  std::variant<double*, std::int64_t*, bool*, Choice, Angle> value;
  std::string unit;
  Range range;
  std::string doc;

  [[nodiscard]] std::string text() const;     ///< Value as written in a file, `0.05`, `true`, `ray`.
  [[nodiscard]] std::string allowed() const;  ///< `0 .. 10 m`, `ray | boundary`, `true | false`.
  /// Sets the value; throws bad_input naming `full_name`, the text and what is allowed.
  void parse(std::string_view text, std::string_view full_name);
  /// Throws bad_input if the value is outside its range or not finite where it must be.
  void check(std::string_view full_name) const;
};

/// Collects the options of an aggregate: `describe(options, visit)` calls it once a field.
class OptionVisitor {
 public:
  explicit OptionVisitor(std::function<void(Option&&)> sink) : sink_(std::move(sink)) {}

  void operator()(std::string name, double& value, std::string unit, Range range, std::string doc) const {
    sink_({std::move(name), &value, std::move(unit), range, std::move(doc)});
  }
  void operator()(std::string name, std::int64_t& value, std::string unit, Range range, std::string doc) const {
    sink_({std::move(name), &value, std::move(unit), range, std::move(doc)});
  }
  void operator()(std::string name, bool& value, std::string doc) const { sink_({std::move(name), &value, "", {}, std::move(doc)}); }
  /// An angle, radians inside; its name ends in `_deg` and its range is in degrees.
  void angle(std::string name, double& radians, Range range, std::string doc) const {
    sink_({std::move(name), Option::Angle{&radians}, "deg", range, std::move(doc)});
  }
  template <class Enum>
    requires std::is_enum_v<Enum>
  void operator()(std::string name, Enum& value, Choices names, std::string doc) const {
    Option::Choice choice{[&value] { return static_cast<int>(value); }, [&value](int v) { value = static_cast<Enum>(v); }, std::move(names)};
    sink_({std::move(name), std::move(choice), "", {}, std::move(doc)});
  }

 private:
  std::function<void(Option&&)> sink_;
};

/// All options of an aggregate that has `describe(Aggregate&, const OptionVisitor&)`. They point into `options`.
template <class Aggregate>
[[nodiscard]] std::vector<Option> list_options(Aggregate& options) {
  std::vector<Option> all;
  describe(options, OptionVisitor([&all](Option&& option) { all.push_back(std::move(option)); }));
  return all;
}

/// Throws bad_input for the first option out of range; `stage` is the prefix in the message.
template <class Aggregate>
void check_options(Aggregate options, std::string_view stage) {
  for (const Option& option : list_options(options)) option.check(std::string(stage) + "." + option.name);
}

}  // namespace vantage
