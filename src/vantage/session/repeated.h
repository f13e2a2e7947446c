// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "vantage/scan/scan.h"

namespace vantage {

/// A scan that is another one once more, and would only pretend to be more.
struct Repetition {
  double share = 0.0;  ///< Of up to 2,000 points of one of the two, those that the other has, too.
  std::string how;     ///< Of a sentence: "those of", "seen from the same place in", "with another pose those of".
};

/// A repetition is one of three:
/// * the same points: nine in ten of the points of one are in the other to within 0.9 mm (a text file rounds), and that one has at most half as many
///   again (a filter takes some away), wherever they are said to have been taken from;
/// * the same view: taken within 5 cm, rays no denser, and nine in ten of its points lie, from there, on what the other's rays near by met, to
///   within 5 cm and 1 % of the range: noise;
/// * one scan under two poses: as the first, but seen from the scanners, and in the world one in a hundred of its points floats clearly in what the
///   other saw to be free. Along a straight corridor and on level ground two places may look alike to the last bit: there nothing floats.
[[nodiscard]] std::optional<Repetition> repetition(const Scan<3>& scan, const Scan<3>& other);

}  // namespace vantage
