// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/survey.h"

#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "line_progress.h"
#include "numbers.h"
#include "progress.h"
#include "scenario_arguments.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/result.h"

using namespace vantage;

namespace {

constexpr const char* kPurpose =
    "Plans the survey of a place whose map is known: the fewest stations from which a scanner measures everything that can be measured within\n"
    "limits of range, incidence and density, a tour through them, and a lower bound on their number.\n";

constexpr const char* kExamples =
    "  vantage survey office -o survey\n"
    "  vantage survey floor --incidence-deg 70 --share 0.98 --overlap 0.2 --height 1.5 -o survey\n"
    "  vantage survey building.obj --density 400 --cover 2 --json";

/// A flag and the option of a survey that it sets; help and range come from the option's own description.
struct SurveyFlag {
  const char *name, *type, *option;
};
constexpr SurveyFlag kFlags[] = {{"--min-range", "METRES", "min_range"}, {"--incidence-deg", "DEGREES", "incidence_deg"},
                                 {"--density", "POINTS", "density"},     {"--cover", "K", "cover"},
                                 {"--overlap", "SHARE", "overlap"},      {"--height", "METRES", "height"},
                                 {"--share", "SHARE", "share"},          {"--samples", "N", "samples"},
                                 {"--candidates", "N", "candidates"},     {"--effort", "N", "effort"}};

Option& find_option(std::vector<Option>& options, std::string_view name) {
  return *std::find_if(options.begin(), options.end(), [&](const Option& option) { return option.name == name; });
}

/// The flags' texts, and what they make of the options.
class SurveyFlags {
 public:
  explicit SurveyFlags(CommandParser& parser) {
    SurveyOptions defaults;
    std::vector<Option> options = list_options(defaults);
    for (std::size_t k = 0; k < std::size(kFlags); ++k) {
      const Option& option = find_option(options, kFlags[k].option);
      parser.option(kFlags[k].name, texts_[k], kFlags[k].type, fmt::format("{} ({}; default {})", option.doc, option.allowed(), option.text()), "Survey");
    }
    parser.flag("--volume", volume_, find_option(options, "volume").doc, "Survey");
    parser.flag("--return", come_back_, find_option(options, "come_back").doc, "Survey");
  }

  [[nodiscard]] SurveyOptions options(const Scenario& scenario) const {
    SurveyOptions o;
    o.range = scenario.sensor.pattern.max_range;
    o.step = scenario.sensor.pattern.step;
    o.min_range = std::max(o.min_range, scenario.sensor.pattern.min_range);
    o.clearance = scenario.explore.planner.clearance;
    o.voxel = scenario.explore.voxel;
    o.seed = scenario.explore.seed;
    o.volume = volume_;
    o.come_back = come_back_;
    std::vector<Option> all = list_options(o);
    for (std::size_t k = 0; k < std::size(kFlags); ++k)
      if (!texts_[k].empty()) find_option(all, kFlags[k].option).parse(texts_[k], kFlags[k].name);
    require(o.min_range < o.range, fmt::format("{}: must be below the range of {} m", o.min_range, o.range), "--min-range");
    return o;
  }

 private:
  std::array<std::string, std::size(kFlags)> texts_;
  bool volume_ = false, come_back_ = false;
};

template <int Dim>
Json as_json(const Survey<Dim>& survey, const std::string& scene) {
  SurveyOptions options = survey.options;
  Json json = {{"scene", scene}, {"dim", Dim}, {"options", Json::object()}};
  for (const Option& option : list_options(options)) json["options"][option.name] = option.text();
  json["stations"] = survey.stations.size();
  json["at_least"] = survey.at_least;
  json["bound"] = survey.bound;
  json["share"] = survey.share;
  json["seen_by_fewer"] = survey.thin;
  json["linked"] = survey.linked;
  json["wall"] = survey.wall;
  json["candidates"] = survey.candidates;
  json["demands"] = survey.demands;
  json["path_m"] = survey.length();
  json["greedy_shares"] = survey.greedy;
  for (const Station<Dim>& s : survey.stations)
    json["places"].push_back({{"place", to_json<Dim>(s.place)}, {"sees", s.sees}, {"adds", s.adds}, {"overlap", s.overlap}, {"partner", s.partner}});
  return json;
}

/// Stations of the greedy choice that see so much, or of all.
std::size_t stations_for(const std::vector<double>& curve, double share) {
  return static_cast<std::size_t>(std::lower_bound(curve.begin(), curve.end(), share) - curve.begin()) + 1;
}

std::string summary(const Json& json, const std::vector<double>& greedy, const std::string& unit) {
  const auto percent = [&](const char* name) { return 100.0 * json[name].get<double>(); };
  std::string out = fmt::format("{}: {} stations; {} or more are needed (bound {:.1f})\n", json["scene"].get<std::string>(),
                                json["stations"].get<std::int64_t>(), json["at_least"].get<std::int64_t>(), json["bound"].get<double>());
  out += fmt::format("  measured  {:.2f} % of {} {} of wall that can be, {} samples\n", percent("share"),
                     grouped(static_cast<std::int64_t>(json["wall"].get<double>() + 0.5)), unit, grouped(json["demands"].get<std::int64_t>()));
  if (percent("seen_by_fewer") > 0.0) out += fmt::format("  thin      {:.2f} % can be seen from fewer places than asked for\n", percent("seen_by_fewer"));
  if (!json["linked"].get<bool>()) out += "  overlap   some stations share too little wall with any other; nothing that joins them was found\n";
  if (!greedy.empty() && greedy.back() >= 0.99)
    out += fmt::format("  by share  {} greedy stations see 90 %, {} 95 %, {} 99 %, {} all, once\n", stations_for(greedy, 0.9), stations_for(greedy, 0.95),
                       stations_for(greedy, 0.99), greedy.size());
  return out + fmt::format("  path      {:.1f} m\n", json["path_m"].get<double>());
}

template <int Dim>
void write_files(const std::filesystem::path& folder, const Survey<Dim>& survey, const Json& json) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) throw Error(ErrorCode::io, "not a folder, and cannot be made one", folder.string());
  write_file(folder / "stations.csv", stations_as_csv(survey));
  write_file(folder / "path.csv", path_as_csv(survey));
  write_file(folder / "survey.json", as_text(json));
  write_file(folder / "report.html", survey_page(survey, json["scene"].get<std::string>()));
}

/// The scene with what the scenario says of it.
template <int Dim>
Scene<Dim> scene_of(const Scene<Dim>& scene, const Scenario& scenario) {
  Scene<Dim> placed = scene;
  placed.start = Eigen::Map<const Vec<Dim>>(scenario.start.data());
  return placed;
}

}  // namespace

int survey_command(const Arguments& arguments) {
  CommandParser parser("survey", "SCENE [-o DIR] [options]", kPurpose, kExamples);
  std::string folder, threads;
  bool json = false, quiet = false;
  SurveyFlags flags(parser);
  parser.option("-o,--output", folder, "DIR", "folder for stations.csv, path.csv, survey.json and report.html", "Output");
  parser.flag("--json", json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  parser.option("--threads", threads, "N", "at most so many threads (default: all cores); the results do not depend on it", "Method");
  ScenarioArguments scenario(parser);
  if (!parser.parse(arguments)) return 0;
  require(!scenario.scene().empty(), "SCENE is missing: vantage scene --list names some");
  const ThreadLimit limit(threads.empty() ? 0 : static_cast<int>(whole_number("--threads", threads, 1, 1024)));
  const World world = make_world(scenario.scene(), scenario.settings());
  const SurveyOptions options = flags.options(world.scenario);
  const StopSignals signals;
  std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        const Survey<Dim> survey = [&] {
          LineProgress progress(quiet);
          return make_survey(scene_of(scene, world.scenario), options, &progress);
        }();
        const Json figures = as_json(survey, world.scenario.scene);
        if (!folder.empty()) write_files(folder, survey, figures);
        if (json)
          fmt::print("{}", as_text(figures));
        else if (!quiet)
          fmt::print("{}{}", summary(figures, survey.greedy, std::array{"m", "m²"}[Dim - 2]), folder.empty() ? "" : "report: " + folder + "/report.html\n");
      },
      world.scene);
  return 0;
}
