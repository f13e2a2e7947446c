// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace vantage {

/// Why a call failed; the value is the exit code of the command line.
enum class ErrorCode : int {
  bad_input = 2,      ///< Wrong option or malformed file.
  io = 3,             ///< A file cannot be read or written.
  memory = 4,         ///< The request does not fit into memory.
  limit = 5,          ///< A limit or the time is used up.
  no_plan = 6,        ///< Unseen space remains and no plan reaches it.
  interrupted = 130,  ///< Stopped by the user; what was done is saved.
};

/// The one exception of the library: the caller's mistake or a bad file, never our own bug (those are assertions).
class Error : public std::runtime_error {
 public:
  /// `message` names what is wrong, the value and what is allowed; `where` is `FILE`, `FILE:OFFSET` or empty.
  Error(ErrorCode code, const std::string& message, std::string where = {});
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const std::string& where() const noexcept { return where_; }

 private:
  ErrorCode code_;
  std::string where_;
};

/// Throws `bad_input` unless `condition` holds.
void require(bool condition, std::string_view message, std::string_view where = {});

/// Throws `memory` if `count` items of `bytes_each` bytes do not fit into the memory that is free now; `what` names them.
void require_memory(double count, double bytes_each, std::string_view what);

}  // namespace vantage
