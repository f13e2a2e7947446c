// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/score.h"

#include <algorithm>

#include "vantage/audit/coverage.h"
#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kDone = 0.99;   // Of the reference set: what a complete run must reach.
constexpr double kIdle = 0.001;  // Smaller gains are waste.

}  // namespace

std::int64_t idle_picks(std::span<const double> coverage) {
  std::int64_t idle = 0;
  for (std::size_t k = 1; k < coverage.size() && coverage[k - 1] < kDone; ++k) idle += coverage[k] - coverage[k - 1] < kIdle ? 1 : 0;
  return idle;
}

template <int Dim>
bool verdict_right(const Verdict<Dim>& verdict, const Coverage& truth) {
  const auto [least, most] = std::minmax(truth.fraction, truth.widely);
  return (verdict.complete ? most >= kDone : least < kDone) && verdict.seen_low <= most && least <= verdict.seen_high;
}

template <int Dim>
RunScore<Dim> score_run(Explorer<Dim>& explorer, const Reference<Dim>& reference, const ScoreLimits& limits, Pilot<Dim>* pilot) {
  RunScore<Dim> score;
  double best = 0.0;
  const auto enough = [&] {
    if (best >= limits.coverage) return !limits.to_the_end;
    return static_cast<std::int64_t>(score.places.size()) >= limits.max_scans;
  };
  while (!explorer.finished() && !enough()) {
    if (pilot != nullptr && !explorer.steps().empty())
      if (const auto place = pilot->next(explorer)) explorer.go_to(*place);
    const StepRecord<Dim>& step = explorer.step();
    const Coverage now = coverage(reference, explorer.states());
    score.places.push_back(step.vantage);
    score.path.push_back((score.path.empty() ? 0.0 : score.path.back()) + step.path_length);
    score.coverage.push_back(now.fraction);
    score.last = now;
    best = std::max(best, now.fraction);
    if (limits.observer != nullptr && limits.observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped");
  }
  score.finished = explorer.finished();
  score.verdict = explorer.verdict();
  score.verdict_right = score.finished && !score.coverage.empty() && verdict_right(score.verdict, score.last);
  return score;
}

template struct RunScore<2>;
template struct RunScore<3>;
template bool verdict_right<2>(const Verdict<2>&, const Coverage&);
template bool verdict_right<3>(const Verdict<3>&, const Coverage&);
template RunScore<2> score_run<2>(Explorer<2>&, const Reference<2>&, const ScoreLimits&, Pilot<2>*);
template RunScore<3> score_run<3>(Explorer<3>&, const Reference<3>&, const ScoreLimits&, Pilot<3>*);

}  // namespace vantage
