// SPDX-License-Identifier: Apache-2.0
// Reading of binary PLY, PCD and LAS beside a plain loop that reads each record of the same file and widens it to double (docs/12-files.md):
//   bench_readers --points 5000000
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/scan_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A file's records: where they begin, how long one is, and how its point is read.
struct Case {
  std::string name, bytes;
  std::size_t begin, record;
  Vec<3> (*point)(const char* record);
};

template <class Number>
double at(const char* record, std::size_t offset) {
  Number value;
  std::memcpy(&value, record + offset, sizeof(Number));
  return static_cast<double>(value);
}

Vec<3> ply_point(const char* r) { return {at<float>(r, 0), at<float>(r, 4), at<float>(r, 8)}; }
Vec<3> pcd_point(const char* r) { return {at<float>(r, 0), at<double>(r, 4), at<float>(r, 12)}; }
Vec<3> las_point(const char* r) { return Vec<3>(at<std::int32_t>(r, 0), at<std::int32_t>(r, 4), at<std::int32_t>(r, 8)) / 1024; }

/// The plain loop: buffered reads of one record at a time.
std::vector<Vec<3>> plain_loop(const fs::path& path, const Case& task, std::size_t count) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  require(file && std::fseek(file.get(), static_cast<long>(task.begin), SEEK_SET) == 0, "cannot read", path.string());
  std::vector<Vec<3>> points;
  points.reserve(count);
  std::vector<char> record(task.record);
  while (points.size() < count && std::fread(record.data(), record.size(), 1, file.get()) == 1) points.push_back(task.point(record.data()));
  return points;
}

/// Processor time, kernel included: the files lie in the page cache [s].
template <class Work>
double best_of(int repeats, Work&& work) {
  double best = kInfinity;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return best;
}

std::vector<Case> cases(const std::vector<Vec<3>>& points) {
  std::vector<Case> list = {{"PLY, little", samples::ply("binary_little_endian", points), 0, 13, ply_point},
                            {"PCD, binary", samples::pcd("binary", points), 0, 18, pcd_point},
                            {"LAS 1.2, format 3", samples::las(2, 3, points), 0, 34, las_point},
                            {"LAS 1.4, format 6", samples::las(4, 6, points), 0, 30, las_point}};
  for (Case& task : list) task.begin = task.bytes.size() - task.record * points.size();
  return list;
}

void run(std::size_t count, int repeats) {
  Random random(1);
  std::vector<Vec<3>> points(count);
  for (Vec<3>& p : points)
    for (int a = 0; a < 3; ++a) p[a] = std::floor(random.uniform(-1e5, 1e5)) / 1024;
  const fs::path path = fs::temp_directory_path() / "bench_readers.bin";
  fmt::print("{} points, best of {}\n\n| file | MB | plain loop [CPU s] | vantage [CPU s] | ratio |\n| --- | --- | --- | --- | --- |\n", count,
             repeats);
  for (const Case& task : cases(points)) {
    write_file(path, task.bytes);
    std::vector<Vec<3>> plain;
    std::vector<MeasuredScan> ours;
    const double slow = best_of(repeats, [&] { plain = plain_loop(path, task, count); });
    const double fast = best_of(repeats, [&] { ours = read_scan_file(path); });
    require(ours.at(0).points == plain, task.name + ": the two differ");
    fmt::print("| {} | {:.0f} | {:.3f} | {:.3f} | {:.2f} |\n", task.name, static_cast<double>(task.bytes.size()) / 1e6, slow, fast, fast / slow);
  }
  fs::remove(path);
}

}  // namespace
}  // namespace vantage

int main(int count, char** arguments) {
  CLI::App app("Reading speed of binary point clouds");
  std::size_t points = 5'000'000;
  int repeats = 5;
  app.add_option("--points", points, "points a file");
  app.add_option("--repeats", repeats, "the best of so many counts");
  CLI11_PARSE(app, count, arguments);
  try {
    vantage::run(points, repeats);
  } catch (const vantage::Error& error) {
    fmt::print(stderr, "bench_readers: {}\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
