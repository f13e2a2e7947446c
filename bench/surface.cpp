// SPDX-License-Identifier: Apache-2.0
// The surface stage beside its peers, on one cloud, in one run (docs/8-surface-bench.md):
//   bench_surface --eta 0.1,0.2 --peers --match --growth --markdown table.md --json table.json
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "tables.h"
#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/point_cloud_file.h"

namespace vantage::bench {
namespace {

struct Settings {
  std::string scene = "town";
  std::vector<double> etas{0.05, 0.1, 0.2, 0.4};
  std::vector<std::string> contenders, sets;
  std::size_t scans = 16;
  int threads = 1;
  bool peers = false, match = false, growth = false;
  double growth_eta = 0.4;
  std::vector<std::size_t> growth_scans{1, 4, 9, 16, 32, 50, 88};
  std::filesystem::path json, markdown, write;
};

/// Gone with its contents at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bench_surface.XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr, name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string spec(const std::string& name, double parameter) { return fmt::format("{}:{:.6g}", name, parameter); }

/// The kind and the parameter of NAME:PARAMETER.
std::pair<const ContenderKind*, std::string> parse_spec(const std::string& text) {
  const std::size_t colon = text.find(':');
  require(colon != std::string::npos, text + ": must be NAME:PARAMETER");
  return {&find_contender(text.substr(0, colon)), text.substr(colon + 1)};
}

/// The contenders asked for, ours first.
std::vector<std::string> lineup(const Settings& s) {
  std::vector<std::string> specs;
  for (const std::string& text : s.contenders) (void)parse_spec(text);  // A wrong name is told before anything is measured.
  for (const double eta : s.etas) specs.emplace_back(spec("vantage", eta));
  specs.insert(specs.end(), s.contenders.begin(), s.contenders.end());
  if (!s.peers) return specs;
  for (const ContenderKind& kind : contenders())
    if (kind.name != "vantage")
      for (const double parameter : kind.parameters) specs.emplace_back(spec(kind.name, parameter));
  return specs;
}

class Bench {
 public:
  explicit Bench(const Settings& settings) : settings_(settings), file_(folder_ / "cloud") {
    const std::size_t most = settings.growth ? std::ranges::max(settings.growth_scans) : settings.scans;
    scene_ = std::get<Scene<3>>(make_scene(settings.scene));
    cloud_ = scan_scene(scene_, std::max(most, settings.scans) + 1);
    save(cloud_, file_);
  }

  [[nodiscard]] const Cloud& cloud() const { return cloud_; }

  /// Every contender on the standard cloud, judged.
  [[nodiscard]] std::vector<Row> quality() const {
    const Judge judge(scene_, cloud_.scans_before(settings_.scans));
    std::vector<Row> rows;
    for (const std::string& name : lineup(settings_)) {
      rows.push_back(judged({name, settings_.scans, settings_.threads, settings_.sets}, judge));
      const Row& last = rows.back();
      if (!settings_.match || !parse_spec(name).first->match || !last.measured.figures.error.empty()) continue;
      Row ours = judged({spec("vantage", last.score.worst()), settings_.scans, settings_.threads, settings_.sets}, judge);
      ours.title = fmt::format("vantage at that error, η {:.3g} m", last.score.worst());
      rows.push_back(std::move(ours));
    }
    return rows;
  }

  /// Ours from one scan to many, on one thread and on two.
  [[nodiscard]] std::vector<Row> growth() const {
    std::vector<Row> rows;
    for (const int threads : {1, 2})
      for (const std::size_t scans : settings_.growth_scans) {
        rows.push_back(measured({spec("vantage", settings_.growth_eta), scans, threads, settings_.sets}));
        rows.back().measured.output.soup = {};
      }
    return rows;
  }

 private:
  [[nodiscard]] Row measured(const Job& job) const {
    fmt::print(stderr, "{}, {} scans\n", job.contender, job.scans);
    const auto [kind, parameter] = parse_spec(job.contender);
    return {job, fmt::format(fmt::runtime(kind->title), parameter), measure(job, file_), {}};
  }
  [[nodiscard]] Row judged(const Job& job, const Judge& judge) const {
    Row row = measured(job);
    row.judged = row.measured.figures.error.empty();
    if (row.judged) row.score = judge.score(row.measured.output.soup);
    row.measured.output.soup = {};
    return row;
  }

  const Settings& settings_;
  TemporaryFolder folder_;
  std::filesystem::path file_;
  Scene<3> scene_;
  Cloud cloud_;
};

void write_cloud(const Cloud& cloud, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < cloud.scans(); ++i) write_file(folder / fmt::format("{:03}.ply", i), points_as_ply<3>(cloud.scan(i)));
}

void run(const Settings& settings) {
  const Bench bench(settings);
  if (!settings.write.empty()) write_cloud(bench.cloud(), settings.write);
  nlohmann::json json{{"points", bench.cloud().first[settings.scans]}};
  std::string text = fmt::format("{} points of {} scans of `{}`.\n\n", bench.cloud().first[settings.scans], settings.scans, settings.scene);
  const auto section = [&](const char* name, const std::vector<Row>& rows, const std::string& table) {
    for (const Row& row : rows) json[name].push_back(as_json(row));
    text += table + "\n";
  };
  const std::vector<Row> rows = bench.quality();
  section("quality", rows, quality_table(rows));
  if (settings.growth) {
    const std::vector<Row> more = bench.growth();
    section("growth", more, growth_table(more));
  }
  fmt::print("{}", text);
  if (!settings.markdown.empty()) write_file(settings.markdown, text);
  if (!settings.json.empty()) write_file(settings.json, json.dump(1) + "\n");
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  vantage::bench::Settings settings;
  vantage::bench::Job job;
  std::filesystem::path cloud, out;
  CLI::App app("The surface stage beside its peers.");
  app.add_option("--scene", settings.scene, "name as in `vantage scene --list`, 3D");
  app.add_option("--scans", settings.scans, "of the standard cloud")->check(CLI::Range(1, 1000));
  app.add_option("--eta", settings.etas, "of ours [m]")->delimiter(',');
  app.add_option("--contenders", settings.contenders, "NAME:PARAMETER, beside ours at --eta")->delimiter(',');
  app.add_flag("--peers", settings.peers, "all that were built in, with the paper's parameters");
  app.add_flag("--match", settings.match, "beside a bounded peer, ours at its largest error");
  app.add_flag("--growth", settings.growth, "cost against the size of the map, on one thread and on two");
  app.add_option("--growth-eta", settings.growth_eta, "[m]");
  app.add_option("--growth-scans", settings.growth_scans, "sizes of the map")->delimiter(',');
  app.add_option("--threads", settings.threads, "of every contender")->check(CLI::Range(1, 256));
  app.add_option("--set", settings.sets, "option=value of the surface stage, for ours");
  app.add_option("--json", settings.json, "all figures");
  app.add_option("--markdown", settings.markdown, "what is printed");
  app.add_option("--write", settings.write, "folder for the cloud, a PLY file a scan");
  CLI::App* child = app.add_subcommand("job", "one measurement; for the program itself");
  child->add_option("contender", job.contender)->required();
  child->add_option("--cloud", cloud)->required();
  child->add_option("--out", out)->required();
  child->add_option("--scans", job.scans)->required();
  child->add_option("--threads", job.threads)->required();
  child->add_option("--set", job.sets);
  CLI11_PARSE(app, argc, argv);
  try {
    if (*child) return vantage::bench::run_job(job, cloud, out);
    vantage::bench::run(settings);
  } catch (const vantage::Error& error) {
    fmt::print(stderr, "bench_surface: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_surface: {}\n", error.what());
    return 1;
  }
  return 0;
}
