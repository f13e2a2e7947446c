// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "judge.h"
#include "measure.h"

namespace vantage::bench {

/// A contender's line.
struct Row {
  Job job;
  std::string title;
  Measured measured;  ///< Without its soup.
  Score score;
  bool judged = false;
};

/// Markdown tables whose columns line up, so that they read well as text.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string markdown() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Time, memory, size, both sides, recall: a contender a line.
[[nodiscard]] std::string quality_table(const std::vector<Row>& rows);
/// The cost against the number of scans, of the map and of one more scan.
[[nodiscard]] std::string growth_table(const std::vector<Row>& rows);
[[nodiscard]] nlohmann::json as_json(const Row& row);

}  // namespace vantage::bench
