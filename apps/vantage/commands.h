// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

/// What follows the command's name.
using Arguments = std::vector<std::string>;

/// Each runs one command and returns the exit code; bad input is thrown as vantage::Error.
int audit_command(const Arguments& arguments);
int config_command(const Arguments& arguments);
int convert_command(const Arguments& arguments);
int explore_command(const Arguments& arguments);
int info_command(const Arguments& arguments);
int merge_command(const Arguments& arguments);
int next_command(const Arguments& arguments);
int paper_command(const Arguments& arguments);
int publish_command(const Arguments& arguments);
int reconstruct_command(const Arguments& arguments);
int scan_command(const Arguments& arguments);
int scene_command(const Arguments& arguments);
int survey_command(const Arguments& arguments);
int visibility_command(const Arguments& arguments);

struct Command {
  std::string_view name, usage, summary;
  int (*run)(const Arguments&);
};

/// In the order of `vantage --help`.
inline constexpr Command kCommands[] = {
    {"explore", "SCENE", "scan, rebuild, find the next vantage point, go there, until done", explore_command},
    {"next", "SCANS… | RUN", "where to put the scanner next, from a person's own scans", next_command},
    {"scan", "SCENE --at x,y,z -o FILE", "one simulated scan to a file", scan_command},
    {"reconstruct", "CLOUD… -o FILE", "surfaces with a certified error from point clouds", reconstruct_command},
    {"publish", "CLOUD… -o MAP", "scans as deltas of a compact map, to exchange with other vehicles", publish_command},
    {"merge", "MAP… -o FILE", "one map of several, the same bytes in any order", merge_command},
    {"survey", "SCENE -o DIR", "the fewest stations that measure a place whose map is known, and a tour", survey_command},
    {"visibility", "PATCHES --from x,y,z -o FILE", "what is seen from a place", visibility_command},
    {"audit", "SCENE… | RUN", "how few scans: runs beside oracles that know the map, and beside other planners", audit_command},
    {"paper", "NAME -o DIR", "a table or figure of the paper, made again", paper_command},
    {"scene", "NAME -o FILE | --list", "write a built-in scene, or list them", scene_command},
    {"info", "FILE | RUN", "what a file or a run folder holds", info_command},
    {"convert", "IN OUT", "a scan, surface or field in another format", convert_command},
    {"config", "dump [SCENE]", "all options with unit, range and meaning, as TOML", config_command},
};
