// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/json_text.h"
#include "vantage/scan/moved.h"
#include "vantage/session/next_answer.h"
#include "vantage/session/next_coverage.h"
#include "vantage/session/next_notes.h"
#include "vantage/session/next_options.h"
#include "vantage/session/next_rule.h"
#include "vantage/session/outputs.h"
#include "vantage/session/playback.h"
#include "vantage/session/repeated.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"
#include "vantage/session/scenario_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr double kCells = 112.0;            // Along the domain's longest side, if nobody says otherwise.
constexpr double kMostNodes = 4e6;          // The lattice is made coarser than that.
constexpr double kTrim = 0.005;             // Share of the points that may lie outside of the domain, at each end of each axis: strays.
constexpr double kNoOverlap = 0.05;         // A scan with less of its points on known surface may be of another place.
constexpr const char* kMeasured = "scans";  // The scene's name in scenario.toml.

template <int Dim>
std::vector<double> numbers_of(const Vec<Dim>& p) {
  return {p.data(), p.data() + Dim};
}

/// A person's scans and the folder they may live in.
class MeasuredRun {
 public:
  MeasuredRun(const NextRequest& request, std::span<const fs::path> files, bool exists, Observer* observer)
      : request_(request), exists_(exists), observer_(observer) {
    if (exists_) {
      settings_ = read_scenario(request.folder / run_file::kNextSettings);
      log_.emplace(ScanLog<3>::open(request.folder / run_file::kScanLog, observer));
      clean_run_folder(request.folder);
    }
    settings_.insert(settings_.end(), request.settings.begin(), request.settings.end());
    setup_ = next_setup(settings_);
    check_lists<3>(setup_.next);
    keep_scans();
    const double range = exists_ && log_->size() > 0 ? log_->read(0).pattern.max_range : 0.0;
    if (!files.empty()) {
      stage("read");
      added_ = read_measured(files, request.poses, setup_.measured, range);
      outcome_.notes.push_back(no_return_note(added_, setup_.measured));
      if (setup_.measured.filter.what != FilterOptions::What::none) outcome_.notes.push_back(filter_note(added_, setup_.measured.filter));
    }
    for (const MeasuredInput& input : added_) outcome_.inputs.push_back(input_line(input));
    if (!request.force) {
      skip_known();
      refuse_repeated();
    }
    require(scans() > 0, "no scans are left", request.folder.string());
  }

  NextOutcome go() {
    settle();
    find_moved();
    Playback<3> playback([this](int k) { return moved_.empty() ? scan(k) : without_points(scan(k), moved_[static_cast<std::size_t>(k)]); });
    ExploreOptions options = setup_.scenario.explore;
    options.max_scans = scans();  // So that the last one's picture is kept.
    options.snapshots = !request_.folder.empty();
    Explorer<3> explorer(playback, scene_.domain, scene_.start, options, observer_);
    StationRule<3> rule = station_rule<3>(setup_.next, options.planner.clearance, true, outcome_.notes);
    const ScanCoverage coverage(scans(), [this](int k) { return scan(k); });
    rule.coverage = coverage.limits();
    explorer.set_rule(std::move(rule));
    play_and_compare(explorer);
    stage("ranking");
    const NextAnswer<3> answer = next_answer<3>(explorer, setup_.next, [this](int k) { return scan(k); }, outcome_.notes);
    outcome_.json = answer_json(answer, explorer);
    outcome_.json["eta_m"] = options.surface.eta;
    outcome_.json["domain"] = {to_json<3>(scene_.domain.low), to_json<3>(scene_.domain.high)};
    const double beyond = coverage.beyond(explorer.view());
    if (const std::string note = coverage.note(beyond); !note.empty()) outcome_.notes.push_back(note);
    outcome_.json["coverage"] = coverage.json(beyond);
    for (const auto& points : moved_) outcome_.json["moved"].push_back(points.size());
    outcome_.json["notes"] = outcome_.notes;
    outcome_.unreachable = answer.ranked.empty() && !answer.verdict.complete;
    if (!request_.folder.empty()) save(explorer, answer);
    return outcome_;
  }

 private:
  void stage(std::string_view name) {
    if (observer_ != nullptr) observer_->stage(name);
  }
  void keep_scans() {
    const int size = exists_ ? log_->size() : 0;
    for (const int index : request_.remove)
      require(index >= 0 && index < size, fmt::format("--remove {}: must be 0 .. {}", index, size - 1), request_.folder.string());
    for (int k = 0; k < size; ++k)
      if (std::find(request_.remove.begin(), request_.remove.end(), k) == request_.remove.end()) kept_.push_back(k);
  }
  /// A scan that is in the folder already, bit for bit, is not added again: a command may be given again after it was stopped.
  void skip_known() {
    if (!exists_) return;
    std::erase_if(added_, [this](const MeasuredInput& input) {
      const std::optional<int> known = log_->find(input.scan);
      if (!known || std::find(kept_.begin(), kept_.end(), *known) == kept_.end()) return false;
      known_.push_back(input_json(input));
      if (observer_ != nullptr) observer_->warn(fmt::format("{}: is scan {} of the run already, and not added again", input.name, *known));
      return true;
    });
  }
  /// A scan counts once: the same points again would only pretend to be more.
  void refuse_repeated() const {
    for (std::size_t k = kept_.size(); k < static_cast<std::size_t>(scans()); ++k)
      for (std::size_t before = 0; before < k; ++before) {
        const std::optional<Repetition> repeated = repetition(scan(static_cast<int>(k)), scan(static_cast<int>(before)));
        if (!repeated) continue;
        const std::string other = before < kept_.size() ? fmt::format("scan {}", kept_[before]) : added_[before - kept_.size()].name;
        throw Error(ErrorCode::bad_input,
                    fmt::format("{:.0f} % of its points are {} {}: a scan counts once (--force adds it all the same)", 100.0 * repeated->share,
                                repeated->how, other),
                    added_[k - kept_.size()].name);
      }
  }
  [[nodiscard]] int scans() const { return static_cast<int>(kept_.size() + added_.size()); }
  [[nodiscard]] Scan<3> scan(int k) const {
    const auto i = static_cast<std::size_t>(k);
    return i < kept_.size() ? log_->read(kept_[i]) : added_[i - kept_.size()].scan;
  }

  /// The log keeps all points: which of them moved is found again with every scan more.
  void find_moved() {
    if (setup_.next.moved == NextOptions::Moved::keep) return;
    stage("moved");
    std::vector<Scan<3>> all;
    for (int k = 0; k < scans(); ++k) all.push_back(scan(k));
    moved_ = moved_points<3>(all, setup_.next.moved_gap);
    std::size_t points = 0, moved = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      points += hit_points(all[k]).size();
      moved += moved_[k].size();
    }
    outcome_.notes.push_back(moved_note(moved, points, setup_.next.moved_gap));
  }

  /// Domain, lattice and tolerance, if nobody set them.
  void settle() {
    Scenario& scenario = setup_.scenario;
    scene_.name = request_.folder.empty() ? fs::path(added_.front().name).stem().string()
                                          : fs::absolute(request_.folder / "x").parent_path().filename().string();
    const Scan<3> first = scan(0);
    scene_.start = first.origin;
    scenario.scene = kMeasured;
    scenario.sensor.pattern.max_range = first.pattern.max_range;
    scenario.start = numbers_of<3>(first.origin);
    Box<3> box = around_points();
    const double longest = box.size().maxCoeff();
    double voxel = scenario.explore.voxel;
    if (scenario.grid > 0) voxel = longest / static_cast<double>(scenario.grid);
    if (!setup_.voxel_set) {
      voxel = std::max(longest / kCells, 0.01);
      double nodes = box.size().prod() / (voxel * voxel * voxel);
      if (nodes > kMostNodes) voxel *= std::cbrt(nodes / kMostNodes);
    }
    scenario.grid = 0;
    // Two digits are enough, and read back as they are.
    if (!setup_.voxel_set) voxel = std::stod(fmt::format("{:.2g}", voxel));
    scenario.explore.voxel = voxel;
    if (!setup_.eta_set) scenario.explore.surface.eta = std::stod(fmt::format("{:.2g}", voxel / 5.0));
    if (setup_.next.domain.empty()) box = box.grown(setup_.next.margin > 0.0 ? setup_.next.margin : 2.0 * voxel);
    scene_.domain = box;
    require_met<3>(setup_.next, box, request_.settings);
  }

  /// The box of all points but the strays, and of the stations.
  [[nodiscard]] Box<3> around_points() const {
    const auto corners = places_of<3>(setup_.next.domain);
    Box<3> box;
    if (!corners.empty()) {
      box = {corners[0], corners[1]};
      for (int k = 0; k < scans(); ++k)
        require(box.contains(scan(k).origin), fmt::format("scan {} was taken at {}, outside of it", k, place_text(scan(k).origin)), "--domain");
      return box;
    }
    std::array<std::vector<double>, 3> values;
    for (int k = 0; k < scans(); ++k) {
      const Scan<3> one = scan(k);
      box.extend(one.origin);
      for (const Vec<3>& p : one.points.empty() ? hit_points(one) : one.points)
        for (int a = 0; a < 3; ++a) values[static_cast<std::size_t>(a)].push_back(p[a]);
    }
    for (int a = 0; a < 3; ++a) {
      auto& v = values[static_cast<std::size_t>(a)];
      const auto cut = static_cast<std::ptrdiff_t>(kTrim * static_cast<double>(v.size()));
      std::nth_element(v.begin(), v.begin() + cut, v.end());
      box.low[a] = std::min(box.low[a], v[static_cast<std::size_t>(cut)]);
      std::nth_element(v.begin(), v.end() - 1 - cut, v.end());
      box.high[a] = std::max(box.high[a], *(v.end() - 1 - cut));
    }
    return box;
  }

  /// Steps through all scans; a new one with hardly a point on what was known before is reported.
  void play_and_compare(Explorer<3>& explorer) {
    for (int k = 0; k < scans(); ++k) {
      if (k > 0 && static_cast<std::size_t>(k) >= kept_.size()) {
        const double share = on_known(explorer.view(), scan(k));
        if (share < kNoOverlap && observer_ != nullptr)
          observer_->warn(fmt::format("{}: only {:.1f} % of its points lie on what the scans before it saw: another place, or a wrong pose?",
                                      added_[static_cast<std::size_t>(k) - kept_.size()].name, 100.0 * share));
      }
      play(explorer, 1, observer_);
    }
  }

  static double on_known(const BeliefView<3>& view, const Scan<3>& scan) {
    std::int64_t inside = 0, near = 0;
    for (const Vec<3>& p : scan.points) {
      const Index<3> node = view.window().nearest(p);
      if (!view.window().inside(node)) continue;
      ++inside;
      near += static_cast<double>(view.known_distance.at(node)) < 1.5 * view.window().spacing ? 1 : 0;
    }
    return inside > 0 ? static_cast<double>(near) / static_cast<double>(inside) : 0.0;
  }

  /// The log first, which is the truth; then all that is made from it.
  void save(const Explorer<3>& explorer, const NextAnswer<3>& answer) {
    std::optional<NewFolder> fresh;
    const fs::path path = request_.folder / run_file::kScanLog;
    if (!exists_) {
      fresh.emplace(request_.folder);
      log_.emplace(ScanLog<3>::create(path));  // First, for whoever holds the log has the folder.
      fresh->own();
      write_file(request_.folder / run_file::kNextSettings, settings_as_toml(settings_));
      write_file(request_.folder / run_file::kScenario, scenario_as_toml(setup_.scenario, false));
    }
    const Json inputs = inputs_json();
    if (!added_.empty()) write_file(request_.folder / run_file::kManifest, as_text({{"inputs", inputs}}));  // The log does not hold the names.
    if (!request_.remove.empty()) {
      log_.reset();
      remove_scans<3>(path, request_.remove);
      log_.emplace(ScanLog<3>::open(path, observer_));
    }
    for (const MeasuredInput& input : added_) log_->append(input.scan);
    if (fresh) fresh->keep();
    write_file(request_.folder / run_file::kNextSettings, settings_as_toml(settings_));
    const NextFigures<3> figures{answer.ranked, answer.verdict, next_plan(answer, setup_.next), outcome_.notes, inputs};
    save_outputs<3>(request_.folder, {setup_.scenario, scene_, explorer, *log_, &figures}, observer_);
    write_file(request_.folder / run_file::kNext, as_text(outcome_.json));
    write_file(request_.folder / run_file::kNextTable, next_csv(answer));
    outcome_.folder = request_.folder;
    outcome_.report = true;
  }

  /// The files of all scans: those the manifest knows, by their checksums, without the removed, and the new ones.
  [[nodiscard]] Json inputs_json() const {
    Json before = known_, inputs = Json::array();
    const fs::path manifest = request_.folder / run_file::kManifest;
    if (exists_ && fs::exists(manifest)) {
      try {
        const Json saved = parse_json<Json>(read_file(manifest), manifest.string());
        if (saved.is_object() && saved.contains("inputs") && saved["inputs"].is_array())
          before.insert(before.end(), saved["inputs"].begin(), saved["inputs"].end());
      } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_input) throw;  // A damaged one costs the scans' names, no scan.
      }
    }
    for (const int k : kept_) {
      const std::string sum = fmt::format("{:08x}", log_->fingerprint(k));
      const auto known =
          std::find_if(before.begin(), before.end(), [&](const Json& entry) { return entry.is_object() && entry.value("crc32", "") == sum; });
      inputs.push_back(known != before.end() ? *known : Json({{"name", fmt::format("scan {}", k)}, {"crc32", sum}}));
    }
    for (const MeasuredInput& input : added_) inputs.push_back(input_json(input));
    return inputs;
  }

  const NextRequest& request_;
  bool exists_;
  Observer* observer_;
  std::vector<Setting> settings_;
  NextSetup setup_;
  std::optional<ScanLog<3>> log_;
  std::vector<int> kept_;
  std::vector<MeasuredInput> added_;
  std::vector<std::vector<std::size_t>> moved_;  ///< Points of every scan; empty: all are kept.
  Json known_ = Json::array();                   ///< Of scans that were named but are there already.
  Scene<3> scene_;
  NextOutcome outcome_;
};

}  // namespace

NextOutcome next_of_measured(const NextRequest& request, std::span<const fs::path> files, bool exists, Observer* observer) {
  return MeasuredRun(request, files, exists, observer).go();
}

}  // namespace vantage
