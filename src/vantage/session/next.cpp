// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/next_answer.h"
#include "vantage/session/next_options.h"
#include "vantage/session/outputs.h"
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
constexpr double kRepeated = 0.9;           // A scan with more of its points in another one is that one.
constexpr const char* kMeasured = "scans";  // The scene's name in scenario.toml.

/// Scans in an order that is given, from a log or from memory.
template <int Dim>
class Playback final : public Sensor<Dim> {
 public:
  using Read = std::function<Scan<Dim>(int)>;
  explicit Playback(Read read) : read_(std::move(read)) {}
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>&, int index) override { return read_(index); }

 private:
  Read read_;
};

template <int Dim>
std::vector<double> numbers_of(const Vec<Dim>& p) {
  return {p.data(), p.data() + Dim};
}

/// An explorer that has gone through all scans.
template <int Dim>
void play(Explorer<Dim>& explorer, int scans, Observer* observer) {
  for (int k = 0; k < scans; ++k) {
    if (observer != nullptr && observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped; nothing was changed");
    static_cast<void>(explorer.step());
  }
}

void must_see(Scenario& scenario, const std::vector<double>& boxes, std::size_t each) {
  constexpr double kWorth = 10.0;
  for (std::size_t k = 0; k + each <= boxes.size(); k += each) {
    auto& weights = scenario.explore.planner.weights;
    weights.insert(weights.end(), boxes.begin() + static_cast<std::ptrdiff_t>(k), boxes.begin() + static_cast<std::ptrdiff_t>(k + each));
    weights.push_back(kWorth);
  }
}

/// A run of `vantage explore`, asked again with a person's wishes.
template <int Dim>
NextOutcome of_explored(const NextRequest& request, const World& world, const Scene<Dim>& scene, Observer* observer) {
  const NextSetup setup = next_setup(request.settings);
  check_lists<Dim>(setup.next);
  require(std::array{false, true}[Dim - 2] || (setup.next.height == 0.0 && setup.next.stand != NextOptions::Stand::ground), "a plane has no heights",
          "--height");
  Scenario scenario = with_settings(
      world.scenario,
      [&] {
        std::vector<Setting> own;
        for (const Setting& setting : request.settings)
          if (!setting.name.starts_with("next.") && !setting.name.starts_with("measured.")) own.push_back(setting);
        return own;
      }(),
      world.scene);
  must_see(scenario, setup.next.must_see, 2 * Dim);
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(request.folder / run_file::kScanLog);
  require(log.size() > 0, "the run has no scans yet", request.folder.string());
  ExploreOptions options = scenario.explore;
  options.snapshots = false;
  options.max_scans = log.size() + 1;
  Playback<Dim> playback([&](int k) { return log.read(k); });
  Explorer<Dim> explorer(playback, scene.domain, Eigen::Map<const Vec<Dim>>(scenario.start.data()), options, observer);
  NextOutcome outcome;
  explorer.set_rule(station_rule<Dim>(setup.next, options.planner.clearance, false, outcome.notes));
  play(explorer, log.size(), observer);
  const NextAnswer<Dim> answer = next_answer(explorer, setup.next);
  outcome.json = answer_json(answer, explorer);
  outcome.folder = request.folder;
  outcome.unreachable = answer.ranked.empty() && !answer.verdict.complete;
  write_file(request.folder / run_file::kNext, as_text(outcome.json));
  write_file(request.folder / run_file::kNextTable, next_csv(answer));
  return outcome;
}

std::string place_text(const Vec<3>& p) { return fmt::format("{:.2f}, {:.2f}, {:.2f}", p[0], p[1], p[2]); }

std::string input_line(const MeasuredInput& input) {
  const BinReport& r = input.report;
  std::string out =
      fmt::format("{}: {} points ({}), taken at {} ({})", input.name, r.points, input.format, place_text(input.scan.origin), input.pose);
  if (r.near > 0) out += fmt::format("; {} nearer than {:g} m left out", r.near, input.scan.pattern.min_range);
  if (r.far > 0) out += fmt::format("; {} beyond {:g} m left out", r.far, input.scan.pattern.max_range);
  if (input.not_finite > 0) out += fmt::format("; {} not finite left out", input.not_finite);
  if (input.filtered.mixed > 0) out += fmt::format("; {} mixed pixels left out", input.filtered.mixed);
  if (input.filtered.isolated > 0) out += fmt::format("; {} isolated points left out", input.filtered.isolated);
  return out;
}

/// What the directions without a hit were taken for.
std::string no_return_note(std::span<const MeasuredInput> inputs, const MeasuredOptions& options) {
  std::int64_t all = 0, empty = 0, outside = 0, between = 0;
  double low = kPi, high = -kPi, step = 0.0, range = 0.0;
  for (const MeasuredInput& input : inputs) {
    all += static_cast<std::int64_t>(input.scan.ranges.size());
    empty += input.report.empty;
    outside += input.report.outside;
    between += input.report.between;
    low = std::min(low, input.report.lowest);
    high = std::max(high, input.report.highest);
    step = std::max(step, input.report.step);
    range = std::max(range, input.scan.pattern.max_range);
  }
  const auto share = [&](std::int64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(all, 1)); };
  const bool free = options.no_return == MeasuredOptions::NoReturn::free;
  return fmt::format(
      "Directions were binned every {:.3g} degrees. Those between elevations of {:.0f} and {:.0f} degrees that hit nothing ({:.1f} %) {}; {:.1f} % "
      "lie "
      "between hits close by, on the surface between them; of the {:.1f} % outside nothing is known.",
      degrees(step), degrees(low), degrees(high), share(empty),
      free ? fmt::format("count as free up to {:g} m (--no-return unknown otherwise)", range) : "count as unknown", share(between), share(outside));
}

/// What the filter took out, by which rule.
std::string filter_note(std::span<const MeasuredInput> inputs, const FilterOptions& options) {
  FilterReport sum;
  for (const MeasuredInput& input : inputs) {
    sum.points += input.filtered.points;
    sum.mixed += input.filtered.mixed;
    sum.isolated += input.filtered.isolated;
  }
  const auto share = [&](std::int64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(sum.points, 1)); };
  using What = FilterOptions::What;
  std::string out = fmt::format("Of {} points the filter left out", sum.points);
  if (options.what != What::isolated)
    out += fmt::format(
        " {} mixed pixels ({:.2f} %: between a nearer and a farther neighbour, both at least {:g} m off and within {:g} degrees of the ray)",
        sum.mixed, share(sum.mixed), options.jump, degrees(options.angle));
  if (options.what != What::mixed)
    out += fmt::format("{} {} isolated points ({:.2f} %: fewer than {} others within {:g} distances between rays)",
                       options.what == What::both ? " and" : "", sum.isolated, share(sum.isolated), options.neighbours, options.radius);
  return out + ". Their rays end where they did: nothing behind them counts as seen.";
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
    Playback<3> playback([this](int k) { return scan(k); });
    ExploreOptions options = setup_.scenario.explore;
    options.max_scans = scans();  // So that the last one's picture is kept.
    options.snapshots = !request_.folder.empty();
    Explorer<3> explorer(playback, scene_.domain, scene_.start, options, observer_);
    explorer.set_rule(station_rule<3>(setup_.next, options.planner.clearance, true, outcome_.notes));
    play_and_compare(explorer);
    stage("ranking");
    const NextAnswer<3> answer = next_answer(explorer, setup_.next);
    outcome_.json = answer_json(answer, explorer);
    outcome_.json["eta_m"] = options.surface.eta;
    outcome_.json["domain"] = {to_json<3>(scene_.domain.low), to_json<3>(scene_.domain.high)};
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
        const SharedPoints shared = shared_points(scan(static_cast<int>(k)), scan(static_cast<int>(before)));
        if (shared.share < kRepeated) continue;
        const std::string other = before < kept_.size() ? fmt::format("scan {}", kept_[before]) : added_[before - kept_.size()].name;
        throw Error(ErrorCode::bad_input,
                    fmt::format("{:.0f} % of its points are those of {}{}: a scan counts once (--force adds it all the same)", 100.0 * shared.share,
                                other, shared.elsewhere ? ", taken at another place" : ""),
                    added_[k - kept_.size()].name);
      }
  }
  [[nodiscard]] int scans() const { return static_cast<int>(kept_.size() + added_.size()); }
  [[nodiscard]] Scan<3> scan(int k) const {
    const auto i = static_cast<std::size_t>(k);
    return i < kept_.size() ? log_->read(kept_[i]) : added_[i - kept_.size()].scan;
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
    must_see(scenario, setup_.next.must_see, 6);
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
    const NextFigures<3> figures{answer.ranked, answer.verdict, outcome_.notes, inputs};
    save_outputs<3>(request_.folder, {setup_.scenario, scene_, explorer, *log_, &figures}, observer_);
    write_file(request_.folder / run_file::kNext, as_text(outcome_.json));
    write_file(request_.folder / run_file::kNextTable, next_csv(answer));
    outcome_.folder = request_.folder;
    outcome_.report = true;
  }

  static Json input_json(const MeasuredInput& input) {
    return {{"name", input.name},
            {"format", input.format},
            {"points", input.report.points},
            {"pose", input.pose},
            {"step_deg", degrees(input.report.step)},
            {"left_out",
             {{"near", input.report.near},
              {"far", input.report.far},
              {"not_finite", input.not_finite},
              {"mixed", input.filtered.mixed},
              {"isolated", input.filtered.isolated}}},
            {"crc32", fmt::format("{:08x}", scan_fingerprint<3>(input.scan))}};
  }

  /// The files of all scans: those the manifest knows, by their checksums, without the removed, and the new ones.
  [[nodiscard]] Json inputs_json() const {
    Json before = known_, inputs = Json::array();
    const fs::path manifest = request_.folder / run_file::kManifest;
    if (exists_ && fs::exists(manifest)) {
      const Json saved = Json::parse(read_file(manifest), nullptr, false);
      if (saved.is_object() && saved.contains("inputs") && saved["inputs"].is_array())
        before.insert(before.end(), saved["inputs"].begin(), saved["inputs"].end());
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
  Json known_ = Json::array();  ///< Of scans that were named but are there already.
  Scene<3> scene_;
  NextOutcome outcome_;
};

}  // namespace

NextOutcome find_next(const NextRequest& given, Observer* observer) {
  NextRequest request = given;
  require(!request.inputs.empty(), "no scans are named: point clouds, or a run folder");
  const ThreadLimit limit(request.threads);
  std::span<const fs::path> files(request.inputs);
  if (fs::path& first = request.inputs.front(); first.filename() == run_file::kScanLog && is_run_folder(fs::absolute(first).parent_path()))
    first = fs::absolute(first).parent_path();  // The log of a run stands for its folder.
  if (restore_replaced_run(request.inputs.front()) && observer != nullptr)
    observer->warn(fmt::format("{}: the run that was to be replaced is back", request.inputs.front().string()));
  const bool exists = is_run_folder(request.inputs.front()) && !has_only_begun(request.inputs.front());
  if (exists) {
    require(request.folder.empty() || fs::weakly_canonical(request.folder) == fs::weakly_canonical(request.inputs.front()),
            "-o: the scans are added to the folder that is named first", request.inputs.front().string());
    request.folder = request.inputs.front();
    files = files.subspan(1);
  }
  for (const fs::path& file : files)
    require(!fs::is_directory(file), exists ? "a folder: only files can be added to a run" : "a folder, and not a run", file.string());
  require(exists || request.remove.empty(), "--remove: only of a run folder");
  require(!files.empty() || (request.poses.list.empty() && request.poses.at.empty()), "--poses, --at: no scans are added");
  if (exists && !fs::exists(request.folder / run_file::kNextSettings)) {
    require(files.empty() && request.remove.empty(),
            "a run of vantage explore: its scans are simulated, a person's cannot be added or taken out here", request.folder.string());
    const World world = make_world((request.folder / run_file::kScenario).string(), {});
    return std::visit([&](const auto& scene) { return of_explored(request, world, scene, observer); }, world.scene);
  }
  if (!exists && !request.folder.empty()) {
    require(!is_run_folder(request.folder) || has_only_begun(request.folder),
            fmt::format("a run is there already: vantage next {} FILE adds a scan to it", request.folder.string()), request.folder.string());
    check_run_folder(request.folder, FolderMode::fresh);
  }
  return MeasuredRun(request, files, exists, observer).go();
}

}  // namespace vantage
