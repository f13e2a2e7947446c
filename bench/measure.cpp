// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "binary.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage::bench {
namespace {

constexpr int kRuns = 3;         ///< At most.
constexpr double kEnough = 5.0;  ///< No further run after this much CPU [s].

using Json = nlohmann::json;

struct Clock {
  double cpu, wall;  ///< [s]
  static Clock now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return {static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec),
            std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()};
  }
};

/// A line of /proc/self/status [MB].
double memory(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == key + ":") {
      double kilobytes = 0.0;
      file >> kilobytes;
      return kilobytes * 1024e-6;
    }
  return 0.0;
}

/// The peak is counted from here on.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

void run(const Job& job, const Cloud& cloud, Measured& out) {
  const std::size_t colon = job.contender.find(':');
  require(colon != std::string::npos, job.contender + ": must be NAME:PARAMETER");
  const ContenderKind& kind = find_contender(job.contender.substr(0, colon));
  const double parameter = std::stod(job.contender.substr(colon + 1));
  require(cloud.scans() >= job.scans, fmt::format("{} scans: the cloud has only {}", job.scans, cloud.scans()));
  Figures& f = out.figures;
  f.points = static_cast<std::int64_t>(cloud.first[job.scans]);
  f.cpu = f.wall = kInfinity;
  double spent = 0.0;
  for (int i = 0; i < kRuns && spent < kEnough; ++i) {
    reset_peak();
    const double before = memory("VmRSS");
    const Clock start = Clock::now();
    const std::unique_ptr<Contender> contender = kind.make(parameter);
    contender->build(cloud, job.scans);
    const Clock built = Clock::now();
    f.cpu = std::min(f.cpu, built.cpu - start.cpu);
    f.wall = std::min(f.wall, built.wall - start.wall);
    spent += built.cpu - start.cpu;
    if (i == 0) {
      f.peak = memory("VmHWM") - before;
      const Clock then = Clock::now();
      out.output = contender->output();
      f.output_cpu = Clock::now().cpu - then.cpu;
    }
    if (cloud.scans() == job.scans) continue;
    const Clock then = Clock::now();
    if (!contender->add(cloud, job.scans)) continue;
    f.add_cpu = std::min(f.add_cpu.value_or(kInfinity), Clock::now().cpu - then.cpu);
    f.added_points = static_cast<std::int64_t>(cloud.scan(job.scans).size());
  }
}

Json optional(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
std::optional<double> optional(const Json& value) { return value.is_null() ? std::nullopt : std::optional(value.get<double>()); }

std::string as_text(const Measured& m) {
  const Figures& f = m.figures;
  const Output& o = m.output;
  return Json{{"cpu", f.cpu},
              {"wall", f.wall},
              {"output_cpu", f.output_cpu},
              {"peak", f.peak},
              {"points", f.points},
              {"add_cpu", optional(f.add_cpu)},
              {"added_points", f.added_points},
              {"primitives", o.primitives},
              {"kind", o.kind},
              {"bytes", o.bytes},
              {"data_to_surface", optional(o.data_to_surface)},
              {"surface_to_data", optional(o.surface_to_data)}}
      .dump();
}

/// A line of JSON, then the soup.
void write(const Measured& m, const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  file << as_text(m) << '\n';
  put(file, m.output.soup);
  file.close();
  require(static_cast<bool>(file), path.string() + ": cannot be written");
}

Measured read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  const Json j = Json::parse(line);
  Measured m;
  m.figures = {j["cpu"], j["wall"], j["output_cpu"], j["peak"], j["points"], optional(j["add_cpu"]), j["added_points"], ""};
  m.output.primitives = j["primitives"];
  m.output.kind = j["kind"];
  m.output.bytes = j["bytes"];
  m.output.data_to_surface = optional(j["data_to_surface"]);
  m.output.surface_to_data = optional(j["surface_to_data"]);
  m.output.soup = get<Piece>(file);
  require(static_cast<bool>(file), path.string() + ": cut off");
  return m;
}

/// Exit status of this program started with other arguments.
int start(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  int status = -1;
  if (posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, argv.data(), environ) != 0) return -1;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

Measured measure(const Job& job, const std::filesystem::path& cloud_file) {
  const std::filesystem::path out = cloud_file.string() + ".out";
  std::vector<std::string> arguments{"bench_surface",
                                     "job",
                                     job.contender,
                                     "--cloud",
                                     cloud_file.string(),
                                     "--out",
                                     out.string(),
                                     "--scans",
                                     std::to_string(job.scans),
                                     "--threads",
                                     std::to_string(job.threads)};
  for (const std::string& set : job.sets) arguments.insert(arguments.end(), {"--set", set});
  const int status = start(arguments);
  Measured m;
  if (status == 0) {
    m = read(out);
  } else {
    m.figures.error = WIFSIGNALED(status) ? fmt::format("died of signal {}", WTERMSIG(status)) : "failed";
  }
  std::filesystem::remove(out);
  return m;
}

int run_job(const Job& job, const std::filesystem::path& cloud_file, const std::filesystem::path& out_file) {
  const ThreadLimit limit(job.threads);
  for (const std::string& set : job.sets) set_surface_option(set);
  Measured m;
  // With the next scan, if there is one.
  const Cloud cloud = load(cloud_file, job.scans + 1);
  run(job, cloud, m);
  write(m, out_file);
  return 0;
}

}  // namespace vantage::bench
