// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/outputs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <system_error>

#include "vantage/base/error.h"
#include "vantage/base/version.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/glb.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/io/vti.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scenario_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReportPoints = 3'000'000;  // More make the pictures no better.

/// Writes files into the run folder and remembers their checksums.
class Folder {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) {}
  void write(const std::string& name, const std::string& bytes) {
    write_file(path_ / name, bytes);
    checksums_[name] = {{"bytes", bytes.size()}, {"crc32", fmt::format("{:08x}", checksum(bytes))}};
  }
  void make(const std::string& name) const {
    std::error_code error;
    fs::create_directories(path_ / name, error);
    if (error) throw Error(ErrorCode::io, "the folder cannot be made: " + error.message(), (path_ / name).string());
  }
  /// Removes the clouds of scans from number `size` on, which have been taken out of the log.
  void forget_scans(int size) const {
    std::error_code error;
    std::vector<fs::path> gone;
    for (fs::directory_iterator it(path_ / run_file::kScans, error), end; !error && it != end; it.increment(error)) {
      const std::string name = it->path().filename().string(), stem = it->path().stem().string();
      int number = 0;
      const auto [rest, failed] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
      if (failed == std::errc() && number >= size && name == fmt::format("{:03}.ply", number)) gone.push_back(it->path());
    }
    for (const fs::path& path : gone)
      if (!error) fs::remove(path, error);
    if (error) throw Error(ErrorCode::io, "clouds of removed scans are left: " + error.message(), (path_ / run_file::kScans).string());
  }
  [[nodiscard]] const Json& checksums() const { return checksums_; }

 private:
  fs::path path_;
  Json checksums_ = Json::object();
};

template <int Dim>
std::string join(const Vec<Dim>& p) {
  return fmt::format("{}", fmt::join(p.data(), p.data() + Dim, ","));
}

/// x,y,z of a place whatever the dimension.
template <int Dim>
std::string in_space(const Vec<Dim>& p) {
  Vec<3> q = Vec<3>::Zero();
  q.template head<Dim>() = p;
  return join<3>(q);
}

template <int Dim>
Eigen::Quaterniond rotation(const Scan<Dim>& scan) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<Dim, Dim>() = scan.world_from_sensor;
  return Eigen::Quaterniond(r);
}

/// Exports the scans one by one (a log may be larger than the memory) and keeps a share of their points for the report.
template <int Dim>
std::vector<std::vector<Vec<Dim>>> save_scans(Folder& folder, const RunOutputs<Dim>& run) {
  folder.make(run_file::kScans);
  std::size_t total = 0;
  for (const StepRecord<Dim>& step : run.explorer.steps()) total += static_cast<std::size_t>(step.points);
  const std::size_t stride = std::max<std::size_t>(1, (total + kReportPoints - 1) / kReportPoints);
  std::vector<std::vector<Vec<Dim>>> kept;
  std::string stations = "id,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i < run.log.size(); ++i) {
    const Scan<Dim> scan = run.log.read(i);
    const std::vector<Vec<Dim>> points = hit_points(scan);
    folder.write(fmt::format("{}/{:03}.ply", run_file::kScans, i), points_as_ply<Dim>(points));
    const Eigen::Quaterniond q = rotation(scan);
    stations += fmt::format("{},{},{},{},{},{}\n", i, in_space<Dim>(scan.origin), q.w(), q.x(), q.y(), q.z());
    std::vector<Vec<Dim>>& some = kept.emplace_back();
    for (std::size_t k = 0; k < points.size(); k += stride) some.push_back(points[k]);
  }
  folder.write(run_file::kStations, stations);
  folder.forget_scans(run.log.size());
  return kept;
}

template <int Dim>
void save_belief(Folder& folder, const Field<Dim, NodeState>& state, const Explorer<Dim>& explorer) {
  static_assert(sizeof(NodeState) == 1);
  const Field<Dim> psi = explorer.psi(), metric = explorer.metric();
  const ImageArray arrays[] = {
      {"state", std::span(reinterpret_cast<const std::uint8_t*>(state.values.data()), state.values.size())},
      {"psi", std::span<const float>(psi.values)},
      {"E", std::span<const float>(metric.values)},
  };
  folder.write(run_file::kBelief, image_as_vti<Dim>(state.window, arrays));
}

template <int Dim>
std::string path_as_csv(const std::vector<Vec<Dim>>& path) {
  std::string out = "x,y,z\n";
  for (const Vec<Dim>& p : path) out += in_space<Dim>(p) + "\n";
  return out;
}

template <int Dim>
std::uint32_t mesh_checksum(const Mesh<Dim>& mesh) {
  std::uint32_t sum = 0;
  for (const Vec<Dim>& v : mesh.vertices) {
    std::string bytes;
    for (int a = 0; a < Dim; ++a) put<double>(bytes, v[a]);
    sum = checksum(bytes, sum);
  }
  for (const auto& facet : mesh.facets) {
    std::string bytes;
    for (const std::uint32_t vertex : facet) put(bytes, vertex);
    sum = checksum(bytes, sum);
  }
  return sum;
}

template <int Dim>
Verdict<Dim> verdict_of(const RunOutputs<Dim>& run) {
  return run.next == nullptr ? run.explorer.verdict() : run.next->verdict;
}

/// The scene without the folders of its files.
std::string short_name(const std::string& scene) {
  std::string out;
  for (std::size_t begin = 0; begin <= scene.size();) {
    const std::size_t end = std::min(scene.find('+', begin), scene.size());
    const fs::path part = scene.substr(begin, end - begin);
    out += (begin > 0 ? "+" : "") + (part.is_absolute() ? part.filename().string() : part.string());
    begin = end + 1;
  }
  return out;
}

template <int Dim>
void save_report(Folder& folder, const RunOutputs<Dim>& run, std::vector<std::vector<Vec<Dim>>> scan_points, std::vector<Patch<Dim>> patches,
                 Field<Dim, NodeState> state) {
  const ReportInput<Dim> input{
      .scene = run.scene.name,
      .command = run.next == nullptr ? "vantage explore " + short_name(run.scenario.scene) : "vantage next " + run.scene.name,
      .settings = settings_table(run.scenario),
      .domain = run.scene.domain,
      .scan_points = std::move(scan_points),
      .patches = std::move(patches),
      .state = std::move(state),
      .path = run.explorer.path(),
      .steps = run.explorer.steps(),
      .snapshots = run.explorer.snapshots(),
      .verdict = verdict_of(run),
      .surface = run.explorer.surface().statistics(),
      .next = run.next == nullptr ? std::vector<RankedPlace<Dim>>() : run.next->ranked,
      .plan = run.next == nullptr ? NextPlan<Dim>() : run.next->plan,
      .notes = run.next == nullptr ? std::vector<std::string>() : run.next->notes};
  folder.write(run_file::kReport, render_report<Dim>(input));
}

}  // namespace

template <int Dim>
Json result_json(const RunOutputs<Dim>& run) {
  Json steps = Json::array();
  double path = 0.0;
  for (const StepRecord<Dim>& step : run.explorer.steps()) {
    steps.push_back(to_json(step));
    path += step.path_length;
  }
  return {{"scene", run.scene.name},
          {"dim", Dim},
          {"scans", run.explorer.steps().size()},
          {"path_m", path},
          {"verdict", to_json(verdict_of(run))},
          {"steps", steps},
          {"surface", to_json(run.explorer.surface().statistics())}};
}

template <int Dim>
Json manifest_json(const Scenario& scenario, const Scene<Dim>& scene) {
  const Json input = {
      {"name", scenario.scene}, {"dim", Dim}, {"facets", scene.mesh.facets.size()}, {"crc32", fmt::format("{:08x}", mesh_checksum(scene.mesh))}};
  return {{"vantage", kVersion}, {"scene", scene.name}, {"seed", scenario.explore.seed}, {"inputs", Json::array({input})}};
}

template <int Dim>
void save_outputs(const fs::path& path, const RunOutputs<Dim>& run, Observer* observer) {
  const auto stage = [&](std::string_view name) {
    if (observer != nullptr) observer->stage(name);
  };
  Folder folder(path);
  stage("files");
  folder.write(run_file::kScenario, scenario_as_toml(run.scenario, false));
  std::vector<std::vector<Vec<Dim>>> points = save_scans(folder, run);
  std::vector<Patch<Dim>> patches = run.explorer.surface().patches();
  folder.write(run_file::kSurface, patches_as_ply<Dim>(patches));
  folder.write(run_file::kSurfaceGlb, surface_as_glb<Dim>(patches, run.explorer.path()));
  Field<Dim, NodeState> state = run.explorer.states();
  save_belief(folder, state, run.explorer);
  folder.write(run_file::kPath, path_as_csv<Dim>(run.explorer.path()));
  folder.write(run_file::kSteps, steps_as_csv(run.explorer.steps()));
  folder.write(run_file::kResult, as_text(result_json(run)));
  stage("report");
  save_report(folder, run, std::move(points), std::move(patches), std::move(state));
  Json manifest = manifest_json(run.scenario, run.scene);
  if (run.next != nullptr) manifest["inputs"] = run.next->inputs;
  manifest["outputs"] = folder.checksums();
  folder.write(run_file::kManifest, as_text(manifest));
}

template Json result_json<2>(const RunOutputs<2>&);
template Json result_json<3>(const RunOutputs<3>&);
template Json manifest_json<2>(const Scenario&, const Scene<2>&);
template Json manifest_json<3>(const Scenario&, const Scene<3>&);
template void save_outputs<2>(const fs::path&, const RunOutputs<2>&, Observer*);
template void save_outputs<3>(const fs::path&, const RunOutputs<3>&, Observer*);

}  // namespace vantage
