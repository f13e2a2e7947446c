// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "vantage/audit/small_scenes.h"
#include "vantage/audit/trial.h"

namespace vantage {

/// A small scene by its name.
struct SmallScene {
  SmallKind kind = SmallKind::box;
  int dim = 2;
  std::uint64_t seed = 1;
  [[nodiscard]] bool operator==(const SmallScene&) const = default;
};

/// What a run came to, and what must hold of every run whatever the place, judged by the truth.
struct Ending {
  std::int64_t scans = 0;
  bool ended = false;                  ///< By itself, before the limit of scans.
  bool reason_true = false;            ///< Nothing contradicts the reason given, see ending.cpp.
  bool verdict_right = false;          ///< See score.h.
  std::int64_t repeated = 0;           ///< Vantage points nearer than half a cell to an earlier one.
  std::int64_t collisions = 0;         ///< Pieces of the way that cross a surface, or vantage points inside a solid.
  std::int64_t unsafe = 0;             ///< Pieces of the way over nodes not seen by then, or too near to the surface known by then.
  double least_clearance = kInfinity;  ///< Of the way to any surface, known or not; at most a metre [m].
  double falsely_free = 0.0;           ///< See Coverage [m^d].
  double share = 0.0, widely = 0.0;    ///< Of the reference set seen at the end, and without what shows only through something narrow [1].
  bool complete = false;               ///< What the verdict said: this, ...
  double low = 0.0, high = 0.0;        ///< ... and its bounds [1],
  std::string reason;                  ///< and its sentence.
  std::string error;                   ///< What was thrown, if anything.

  /// None of the above went wrong; falsely free volume is reported, not judged.
  [[nodiscard]] bool good() const {
    return error.empty() && ended && reason_true && verdict_right && repeated == 0 && collisions == 0 && unsafe == 0;
  }
};

/// Options of all such runs: coarse rays to match the coarse lattice.
template <int Dim>
[[nodiscard]] TrialOptions small_options(const Scene<Dim>& scene);

/// Changes the options of a run before it begins.
using AdjustOptions = std::function<void(TrialOptions&)>;

/// Explores the scene to its end, with small_options(), adjusted. An error of the explorer becomes part of the result; throws interrupted when the
/// observer asks to stop.
[[nodiscard]] Ending play_to_end(const SmallScene& scene, const AdjustOptions& adjust = {}, Observer* observer = nullptr);
template <int Dim>
[[nodiscard]] Ending play_to_end(const Scene<Dim>& scene, const TrialOptions& options, Observer* observer = nullptr);

}  // namespace vantage
