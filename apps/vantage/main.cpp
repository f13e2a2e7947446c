// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>

#include "commands.h"
#include "vantage/base/error.h"
#include "vantage/base/version.h"
#include "vantage/session/suggest.h"

namespace {

std::string help() {
  std::string out =
      "vantage explores unknown places with a LiDAR: it scans, rebuilds the surfaces within a known error, works out what has not been\n"
      "seen, and goes where most of it will come into view.\n\nusage: vantage COMMAND …\n\n";
  for (const Command& command : kCommands) out += fmt::format("  {:<12} {}\n", command.name, command.summary);
  return out +
         "\nStart here:\n"
         "  vantage explore town            explore the built-in town; ends with a report to open in a browser\n"
         "  vantage scene --list            what else there is to explore\n"
         "  vantage explore --help          every option, with unit and range\n\n"
         "Other:  --version   --help\n";
}

int unknown_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : kCommands) names.emplace_back(command.name);
  throw vantage::Error(vantage::ErrorCode::bad_input, fmt::format("{}: unknown command{}", name, vantage::did_you_mean(name, names)));
}

int dispatch(const Arguments& all) {
  const std::string name = all.empty() ? "--help" : all.front();
  const bool asks_command = name == "help" && all.size() > 1;
  if (name == "--help" || name == "-h" || (name == "help" && !asks_command)) {
    fmt::print("{}", help());
    return all.empty() ? 2 : 0;
  }
  if (name == "--version" || name == "-V") {
    fmt::print("vantage {}\n", vantage::kVersion);
    return 0;
  }
  const std::string wanted = asks_command ? all[1] : name;
  const auto command = std::find_if(std::begin(kCommands), std::end(kCommands), [&](const Command& c) { return c.name == wanted; });
  if (command == std::end(kCommands)) return unknown_command(wanted);
  return command->run(asks_command ? Arguments{"--help"} : Arguments(all.begin() + 1, all.end()));
}

/// One line, whatever the message holds.
int report(vantage::ErrorCode code, std::string message) {
  std::replace_if(message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  static_cast<void>(std::fputs(("vantage: " + message + "\n").c_str(), stderr));  // If even that fails, the exit code says it.
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int code = dispatch(Arguments(argv + 1, argv + argc));
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? code : report(vantage::ErrorCode::io, "the output cannot be written");
  } catch (const vantage::Error& error) {
    return report(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return report(vantage::ErrorCode::memory, "not enough memory: try a larger --voxel");
  } catch (const std::exception& error) {
    return report(vantage::ErrorCode::io, error.what());
  }
}
