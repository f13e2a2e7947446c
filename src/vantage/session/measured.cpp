// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/io/scan_file.h"
#include "vantage/session/poses.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr double kBeyond = 1.5;      // Times the range of all but these: farther ones are left out.
constexpr double kNearest = 2e4;     // A scanner's nearest point is not farther [m].
constexpr double kFarShare = 0.001;  // Of the points that may lie beyond the range: strays and mixed pixels.

/// A scan of a file and the file it is from.
struct Loaded {
  MeasuredScan scan;
  std::string stem;
};

std::vector<Loaded> load(std::span<const fs::path> files) {
  std::vector<Loaded> all;
  for (const fs::path& file : files)
    for (MeasuredScan& scan : read_scan_file(file)) {
      require(scan.dim == 3, "a scan of a plane: only scans of space are read here", scan.name);
      require(!scan.points.empty(), "no points in it", scan.name);
      all.push_back({std::move(scan), file.stem().string()});
    }
  return all;
}

/// The poses of a list, one a scan: by the names where every file has its own line, else in order.
std::vector<FilePose> matched(const fs::path& list, std::span<const Loaded> scans) {
  std::vector<FilePose> poses = read_poses(list), chosen;
  for (const Loaded& scan : scans) {
    const auto same = [&](const FilePose& pose) { return !pose.name.empty() && (pose.name == scan.stem || fs::path(pose.name).stem() == scan.stem); };
    if (std::count_if(poses.begin(), poses.end(), same) == 1) chosen.push_back(*std::find_if(poses.begin(), poses.end(), same));
  }
  if (chosen.size() == scans.size()) return chosen;
  require(poses.size() == scans.size(),
          fmt::format("{} poses for {} scans, and not every file's name has a line of its own", poses.size(), scans.size()), list.string());
  return poses;
}

/// Metres, z up.
class Converter {
 public:
  explicit Converter(const MeasuredOptions& options) : options_(options), turn_(upright(options.up)) {}
  [[nodiscard]] Vec<3> place(const Vec<3>& p) const { return turn_ * p * options_.unit; }
  [[nodiscard]] Eigen::Matrix3d rotation(const Eigen::Quaterniond& q) const { return turn_ * q.toRotationMatrix() * turn_.transpose(); }

 private:
  const MeasuredOptions& options_;
  Eigen::Matrix3d turn_;
};

struct Placed {
  Pose<3> pose;
  bool moved = false;  ///< The points stand in the scanner's frame.
  std::string source;
};

Placed placed(const MeasuredScan& scan, const Converter& convert) {
  require(scan.position.has_value(),
          "the file does not say where the scan was taken: --at x,y,z gives the scanner's place, --poses FILE those of several scans", scan.name);
  return {{convert.place(*scan.position), convert.rotation(scan.orientation)}, false, "the file"};
}

Placed placed(const FilePose& given, const Converter& convert, const MeasuredOptions& options, const std::string& source) {
  Placed placed{{convert.place(given.position), Eigen::Matrix3d::Identity()}, false, source};
  if (given.orientation) placed.pose.world_from_sensor = convert.rotation(*given.orientation);
  using Frame = MeasuredOptions::Frame;
  placed.moved = options.frame == Frame::sensor || (options.frame == Frame::pose && given.orientation.has_value());
  return placed;
}

/// The points where they belong. A pose of the file has been applied to them already.
std::vector<Vec<3>> in_world(const MeasuredScan& scan, const Placed& placed, const Converter& convert) {
  std::vector<Vec<3>> points = scan.points;
  if (placed.moved && scan.position)
    for (Vec<3>& p : points) p = scan.orientation.conjugate() * (p - *scan.position);
  for (Vec<3>& p : points) {
    p = convert.place(p);
    if (placed.moved) p = placed.pose.world_from_sensor * p + placed.pose.position;
  }
  return points;
}

/// A place in other coordinates than the points would make a scan of a speck far away.
void check_place(const std::vector<Vec<3>>& points, const Placed& placed, const std::string& name) {
  const Vec<3>& at = placed.pose.position;
  double nearest = kInfinity;
  for (const Vec<3>& p : points) nearest = std::min(nearest, (p - at).norm());
  require(!std::isfinite(nearest) || nearest <= kNearest,
          fmt::format("all points are farther than {:.0f} km from the scanner at {:.10g},{:.10g},{:.10g} ({}): must be at most {:.0f} km; "
                      "points and place in the same coordinates?",
                      std::floor(1e-3 * nearest), at.x(), at.y(), at.z(), placed.source, 1e-3 * kNearest),
          name);
}

double range_of(std::span<const std::vector<Vec<3>>> clouds, std::span<const Placed> placed) {
  std::vector<double> ranges;
  for (std::size_t k = 0; k < clouds.size(); ++k)
    for (const Vec<3>& p : clouds[k]) ranges.push_back((p - placed[k].pose.position).norm());
  const auto far = static_cast<std::ptrdiff_t>(kFarShare * static_cast<double>(ranges.size()));
  std::nth_element(ranges.begin(), ranges.end() - 1 - far, ranges.end());
  const double most = kBeyond * *(ranges.end() - 1 - far);
  return std::max(1.0, std::ceil(std::min(most, *std::max_element(ranges.begin(), ranges.end()))));
}

/// Where the file leaves open which rays were fired, the option decides.
std::optional<RayOrder> order_of(const MeasuredScan& scan, MeasuredOptions::NoReturn no_return) {
  if (!scan.rays || (scan.rays->assumed && no_return == MeasuredOptions::NoReturn::unknown)) return std::nullopt;
  return RayOrder{scan.rays->columns, scan.rays->rows, scan.rays->point};
}

}  // namespace

Eigen::Matrix3d upright(MeasuredOptions::Up up) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  if (up == MeasuredOptions::Up::x) r << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  if (up == MeasuredOptions::Up::y) r << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == MeasuredOptions::Up::down) r << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return r;
}

void describe(MeasuredOptions& o, const OptionVisitor& visit) {
  visit("unit", o.unit, "m", Range{1e-6, 1e6}, "metres per unit of the files and of a list of poses");
  visit("up", o.up, Choices{"x", "y", "z", "down"}, "axis of the files that points up; down: z points down");
  visit("frame", o.frame, Choices{"pose", "sensor", "world"},
        "frame of the points beside --poses or --at; pose: the scanner's if the poses have rotations, else the world's");
  visit("no_return", o.no_return, Choices{"free", "unknown"},
        "directions within the measured field of view that hit nothing: free up to the range, or nothing is known of them");
  visit("min_range", o.min_range, "m", Range{0.0, 1e4}, "nearer points are hits of the scanner's own stand and left out");
  visit("range", o.range, "m", Range{0.0, 1e5},
        "farther points are left out; 0: by the points, half as far again as all but the farthest in a thousand lie");
  visit.angle("step_deg", o.step, Range{0.0, 30.0}, "angle between rays of the range image; 0: by the points");
  describe(o.filter, visit);
}

std::vector<MeasuredInput> read_measured(std::span<const fs::path> files, const GivenPoses& given, const MeasuredOptions& options, double range) {
  check_options(options, "measured");
  require(given.list.empty() || given.at.empty(), "--poses and --at: one of them");
  const std::vector<Loaded> scans = load(files);
  require(given.at.empty() || given.at.size() == scans.size(), fmt::format("{} places for {} scans", given.at.size(), scans.size()), "--at");
  const std::vector<FilePose> listed = given.list.empty() ? std::vector<FilePose>{} : matched(given.list, scans);
  const Converter convert(options);
  std::vector<Placed> places;
  std::vector<std::vector<Vec<3>>> clouds;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const MeasuredScan& scan = scans[k].scan;
    if (!listed.empty())
      places.push_back(placed(listed[k], convert, options, given.list.filename().string()));
    else if (!given.at.empty())
      places.push_back({{given.at[k], Eigen::Matrix3d::Identity()}, options.frame == MeasuredOptions::Frame::sensor, "--at"});
    else
      places.push_back(placed(scan, convert));
    clouds.push_back(in_world(scan, places.back(), convert));
    check_place(clouds.back(), places.back(), scan.name);
  }
  BinOptions bins{options.step, options.min_range, options.range, options.no_return == MeasuredOptions::NoReturn::free};
  if (bins.max_range == 0.0) bins.max_range = std::max(range, range_of(clouds, places));
  require(bins.min_range < bins.max_range, fmt::format("--min-range {:g}: must be less than the range, {:g} m", bins.min_range, bins.max_range));
  std::vector<MeasuredInput> inputs;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const MeasuredScan& scan = scans[k].scan;
    try {
      BinnedScan<3> binned = bin_points<3>(clouds[k], places[k].pose, bins, order_of(scan, options.no_return));
      const FilterReport filtered =
          filter_points(binned.scan.points, {binned.scan.origin, binned.scan.world_from_sensor}, binned.report.step, options.filter);
      require(!binned.scan.points.empty(), "no points are left by the filter");
      inputs.push_back(
          {std::move(binned.scan), binned.report, filtered, fs::path(scan.name).filename().string(), scan.format, places[k].source, scan.not_finite});
    } catch (const Error& error) {
      throw Error(error.code(), error.what(), scan.name);
    }
  }
  return inputs;
}

}  // namespace vantage
