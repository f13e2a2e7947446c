// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next.h"

#include <fmt/format.h>

#include <list>

#include "arguments.h"
#include "line_progress.h"
#include "numbers.h"
#include "progress.h"
#include "vantage/base/error.h"
#include "vantage/session/next_options.h"
#include "vantage/session/run_folder.h"

using vantage::Error;
using vantage::ErrorCode;
using vantage::Json;
using vantage::require;
using vantage::Setting;

namespace {

constexpr const char* kPurpose =
    "Where to put the scanner next: from scans that were taken, the places from which most of what is still hidden would come into\n"
    "view, best first, with the way there over the ground. Scans are point clouds and where each was taken from: the file says it, or\n"
    "--poses FILE, or --at x,y,z; it is never guessed. With -o the scans are kept in a run folder, which further scans can be added to.\n";

constexpr const char* kExamples =
    "  vantage next hall1.pcd hall2.pcd --poses poses.csv -o hall      keep them in a folder, with a report\n"
    "  vantage next hall hall3.pcd --at 12.5,3,1.6                     the next scan is there: add it and ask again\n"
    "  vantage next hall --height 1.2 --keep-out 0,0,-1,4,2,3          other wishes, the same scans\n"
    "  vantage next scan.xyz --at 0,0,0 --json                         nothing is written\n"
    "  vantage next runs/town                                          a run of vantage explore\n"
    "Exit: 0 done, 6 unseen space remains and no place to scan it from, 2 bad input, 3 files, 4 memory.";

/// A flag that sets one option.
struct Flag {
  const char *name, *type, *option, *group;
};
constexpr Flag kFlags[] = {
    {"--count", "N", "next.count", "Next station"},
    {"--height", "METRES", "next.height", "Next station"},
    {"--stand", "WHERE", "next.stand", "Next station"},
    {"--slope-deg", "DEGREES", "next.slope_deg", "Next station"},
    {"--step", "METRES", "next.step", "Next station"},
    {"--clearance", "METRES", "planner.clearance", "Next station"},
    {"--incidence-deg", "DEGREES", "next.incidence_deg", "Next station"},
    {"--overlap", "SHARE", "next.overlap", "Next station"},
    {"--apart", "METRES", "next.apart", "Next station"},
    {"--frame", "FRAME", "measured.frame", "Scans"},
    {"--up", "AXIS", "measured.up", "Scans"},
    {"--no-return", "WHAT", "measured.no_return", "Scans"},
    {"--range", "METRES", "measured.range", "Scans"},
    {"--min-range", "METRES", "measured.min_range", "Scans"},
    {"--step-deg", "DEGREES", "measured.step_deg", "Scans"},
    {"--filter", "WHAT", "measured.filter", "Scans"},
    {"--moved", "WHAT", "next.moved", "Scans"},
    {"--eta", "METRES", "surface.eta", "Method"},
    {"--voxel", "METRES", "explore.voxel", "Method"},
    {"--grid", "CELLS", "explore.grid", "Method"},
    {"--margin", "METRES", "next.margin", "Method"},
    {"--seed", "N", "explore.seed", "Method"},
};

/// Lists, given once or several times.
struct ListFlag {
  const char *name, *type, *option, *help;
  const char* joint = ",";
};
constexpr ListFlag kLists[] = {
    {"--domain", "x0,y0,z0,x1,y1,z1", "next.domain", "what is to be seen, a box [m] (default: around the points, without strays)"},
    {"--keep-out", "ZONE", "next.keep_out",
     "where no scanner may stand or pass: a box x0,y0,z0,x1,y1,z1 [m], a polygon \"x,y x,y x,y\" or a file of polygons (.geojson, .csv) in the "
     "coordinates of the scans, with heights by \"... z=LOW..HIGH\"; several: give it again",
     "; "},
    {"--must-see", "ZONE", "next.must_see", "where what is hidden counts ten times: a zone as above; several: give it again", "; "},
    {"--among", "x,y,z", "next.among", "only this place comes into question [m]; several: give it again"},
    {"--planned", "x,y,z", "next.planned", "a station that is planned already: what it will show is not counted again [m]; several: give it again"},
};

std::string help_of(const std::string& name) {
  vantage::NextOptions next;
  vantage::MeasuredOptions measured;
  vantage::Scenario scenario;
  const auto text = [](const vantage::Option& option, const std::string& full) {
    return fmt::format("{} ({}; {})", option.doc, option.allowed(), full);
  };
  for (const vantage::Option& option : vantage::list_options(next))
    if ("next." + option.name == name) return text(option, name);
  for (const vantage::Option& option : vantage::list_options(measured))
    if ("measured." + option.name == name) return text(option, name);
  for (const vantage::Option& option : list_options(scenario))
    if (option.name == name) return text(option, name);
  return name;
}

/// What the command line holds.
class NextFlags {
 public:
  explicit NextFlags(CommandParser& parser) {
    parser.app().add_option("SCANS", inputs_, "point clouds, or a run folder and clouds to add to it");
    parser.option("--poses", poses_, "FILE",
                  "where the scans were taken: CSV x,y,z[,qw,qx,qy,qz], KITTI 3x4, TUM, by the files' names or in their order; beats the files",
                  "Scans");
    parser.app()
        .add_option("--at", at_, "where the scan was taken [m]; of several scans once for each, in their order")
        ->type_name("x,y,z")
        ->group("Scans");
    parser.option("--unit", unit_, "UNIT", "of files and poses: m, cm, mm, ft, us-ft, in, or metres as a number (measured.unit)", "Scans");
    for (const Flag& flag : kFlags) options_.push_back(parser.option(flag.name, texts_.emplace_back(), flag.type, help_of(flag.option), flag.group));
    for (const ListFlag& flag : kLists)
      parser.app().add_option(flag.name, lists_.emplace_back(), flag.help)->type_name(flag.type)->group("Next station");
    parser.app()
        .add_option("--set", sets_, "any option: next.*, measured.*, explore.*, surface.*, visibility.*, planner.*")
        ->type_name("STAGE.OPTION=VALUE")
        ->group("Method");
    parser.option("-o,--output", folder_, "RUN", "keep the scans in this new run folder, with next.json, next.csv and a report", "Run");
    parser.app()
        .add_option("--remove", remove_,
                    "take scan K out of the run first (several: --remove 3 --remove 7); the log as it was stays in scans.log.bak")
        ->type_name("K")
        ->group("Run");
    parser.flag("--force", force_, "add a scan even if its points are those of another one", "Run");
    parser.option("--threads", threads_, "N", "at most so many threads (default: all cores); the results do not depend on it", "Run");
  }

  [[nodiscard]] vantage::NextRequest request() const {
    require(!inputs_.empty(), "SCANS is missing: point clouds, or a run folder");
    vantage::NextRequest request;
    for (const std::string& input : inputs_) request.inputs.emplace_back(input);
    request.folder = folder_;
    request.poses.list = poses_;
    for (const std::string& text : at_) request.poses.at.push_back(place(text));
    request.settings = settings();
    for (const std::string& index : remove_) request.remove.push_back(static_cast<int>(whole_number("--remove", index, 0, 1'000'000)));
    request.force = force_;
    if (!threads_.empty()) request.threads = static_cast<int>(whole_number("--threads", threads_, 1, 1024));
    return request;
  }

 private:
  static vantage::Vec<3> place(const std::string& text) {
    const std::vector<double> p = numbers("--at", text);
    require(p.size() == 3, fmt::format("{}: must be x,y,z", text), "--at");
    return {p[0], p[1], p[2]};
  }
  [[nodiscard]] std::vector<Setting> settings() const {
    std::vector<Setting> all;
    for (const std::string& text : sets_) all.push_back(vantage::parse_setting(text, "--set"));
    if (!unit_.empty()) all.push_back({"measured.unit", metres(unit_), "--unit"});
    std::size_t k = 0;
    for (const std::string& text : texts_) {
      if (options_[k]->count() > 0) all.push_back({kFlags[k].option, text, kFlags[k].name});
      ++k;
    }
    k = 0;
    for (const std::vector<std::string>& texts : lists_) {
      if (!texts.empty()) all.push_back({kLists[k].option, fmt::format("{}", fmt::join(texts, kLists[k].joint)), kLists[k].name});
      ++k;
    }
    return all;
  }
  static std::string metres(const std::string& unit) {
    constexpr std::pair<const char*, const char*> kUnits[] = {
        {"m", "1"}, {"cm", "0.01"}, {"mm", "0.001"}, {"ft", "0.3048"}, {"us-ft", "0.30480060960121924"}, {"in", "0.0254"}};
    for (const auto& [name, value] : kUnits)
      if (unit == name) return value;
    return unit;
  }

  std::vector<std::string> inputs_, at_, sets_, remove_;
  std::string poses_, unit_, folder_, threads_;
  bool force_ = false;
  std::list<std::string> texts_;  // The parser points into them.
  std::list<std::vector<std::string>> lists_;
  std::vector<CLI::Option*> options_;
};

std::string place_text(const Json& p) {
  std::string out;
  for (const Json& x : p) out += fmt::format("{}{:.2f}", out.empty() ? "" : ", ", x.get<double>());
  return out;
}

std::string volume(double value) { return value < 100.0 ? fmt::format("{:.3g}", value) : grouped(static_cast<std::int64_t>(value + 0.5)); }

std::string answer_text(const vantage::NextOutcome& outcome) {
  const Json& j = outcome.json;
  const bool plane = j["dim"].get<int>() == 2;
  const char *unit = plane ? "m²" : "m³", *side = plane ? "m" : "m²";
  std::string out;
  for (const std::string& line : outcome.inputs) out += line + "\n";
  const auto number = [](const Json& value) { return value.is_number() ? value.get<double>() : 0.0; };
  if (j["ranked"].empty()) {
    out += fmt::format("next: nowhere. {}\n", j["verdict"]["reason"].get<std::string>());
  } else {
    const Json& best = j["ranked"][0];
    out += fmt::format("next: {}\n", place_text(best["vantage"]));
    out += fmt::format(
        "  why      it faces {} {} of the border of what was seen, and would show about {} {} more; {:.0f} % of its view is known surface\n",
        volume(number(best["new_area_m2"])), side, volume(number(best["new_volume_m3"])), unit, 100.0 * number(best["overlap"]));
    if (number(best["mended_m2"]) > 0.0)
      out += fmt::format("  mends    {} {} of surface that was only seen too flat\n", volume(number(best["mended_m2"])), side);
    out += fmt::format("  way      {:.1f} m from the last scan, {} turns\n", number(best["path_m"]), j["path"].size() > 2 ? j["path"].size() - 2 : 0);
    for (std::size_t k = 1; k < j["ranked"].size(); ++k) {
      const Json& place = j["ranked"][k];
      out += fmt::format("  {:<8} {}: {} {} beyond the better ones, {:.1f} m away\n", k == 1 ? "or" : "", place_text(place["vantage"]),
                         volume(number(place["added_volume_m3"])), unit, number(place["path_m"]));
    }
    if (const Json& tour = j["tour"]; tour["order"].size() > 1)
      out += fmt::format("  tour     of all of them: {}; {:.1f} m\n", fmt::join(tour["order"].get<std::vector<int>>(), ", "), number(tour["path_m"]));
  }
  out += fmt::format("  seen     {} {} by {} scans; {:.1f} % of what can be seen (between {:.1f} and {:.1f} %)\n", volume(number(j["seen_m3"])), unit,
                     j["scans"].get<int>(), 100.0 * number(j["verdict"]["seen_fraction"]), 100.0 * number(j["verdict"]["seen_fraction_bounds"][0]),
                     100.0 * number(j["verdict"]["seen_fraction_bounds"][1]));
  out += fmt::format("  unseen   {} {}", volume(number(j["unseen_m3"])), unit);
  const Json& unseen = j["verdict"]["unseen"];
  for (std::size_t k = 0; k < std::min<std::size_t>(3, unseen.size()); ++k)
    out += fmt::format("{} {} {} ({})", k == 0 ? "; largest" : ",", volume(number(unseen[k]["volume_m3"])), unit,
                       unseen[k]["reason"].get<std::string>());
  out += "\n";
  if (const Json& flat = j["flat"]; !flat.is_null())
    out += fmt::format("  flat     {} {} of surface only seen flatter than {:g} degrees, in {} regions\n", volume(number(flat["area_m2"])), side,
                       number(flat["limit_deg"]), flat["regions"].size());
  for (const std::string& note : outcome.notes) out += fmt::format("note: {}\n", note);
  if (!outcome.folder.empty()) {
    const char* file = outcome.report ? vantage::run_file::kReport : vantage::run_file::kNext;
    out += fmt::format("{}: {}\n", outcome.report ? "report" : "written", (outcome.folder / file).string());
  }
  return out;
}

}  // namespace

int next_command(const Arguments& arguments) {
  CommandParser parser("next", "SCANS… | RUN [SCANS…] [options]", kPurpose, kExamples);
  const NextFlags flags(parser);
  bool json = false, quiet = false;
  parser.flag("--json", json, "print next.json on stdout instead of the text", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing, no warnings", "Output");
  if (!parser.parse(arguments)) return 0;
  const vantage::NextRequest request = flags.request();
  const StopSignals signals;
  const vantage::NextOutcome outcome = [&] {
    LineProgress progress(quiet);
    return find_next(request, &progress);
  }();
  if (json)
    fmt::print("{}", vantage::as_text(outcome.json));
  else if (!quiet)
    fmt::print("{}", answer_text(outcome));
  return outcome.unreachable ? static_cast<int>(ErrorCode::no_plan) : 0;
}
