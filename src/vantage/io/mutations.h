// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/bytes.h"

/// Small random damage to files, for tests of readers.
namespace vantage {

/// Changes a test makes of each file: VANTAGE_MUTATIONS, else 300.
inline int mutation_count() {
  const char* asked = std::getenv("VANTAGE_MUTATIONS");
  return asked != nullptr ? std::atoi(asked) : 300;
}

inline void flip_bit(std::string& bytes, Random& random) {
  const std::size_t at = random.below(bytes.size());
  bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
}

inline void set_byte(std::string& bytes, Random& random) {
  constexpr char kBytes[] = {'\0', '\1', '\x7f', '\x80', '\xff', '0', '9', '-', '.', 'e', ' ', '\n'};
  bytes[random.below(bytes.size())] = kBytes[random.below(std::size(kBytes))];
}

/// What a size or a count might say.
inline void set_number(std::string& bytes, Random& random) {
  constexpr std::uint64_t kNumbers[] = {0, 1, 2, 0x7f, 0xff, 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, 0xffffffffffffffff};
  std::string number;
  put(number, kNumbers[random.below(std::size(kNumbers))]);
  const std::size_t width = std::size_t{1} << random.below(4);
  const std::size_t at = random.below(bytes.size());
  bytes.replace(at, std::min(width, bytes.size() - at), number.substr(0, width));
}

/// A number of a text header.
inline void set_digits(std::string& bytes, Random& random) {
  constexpr const char* kWords[] = {"0", "-1", "nan", "1e999", "4294967296", "18446744073709551615", "99999999999999999999", ""};
  const std::size_t from = bytes.find_first_of("0123456789", random.below(bytes.size()));
  if (from == std::string::npos) return;
  bytes.replace(from, std::min(bytes.find_first_not_of("0123456789", from), bytes.size()) - from, kWords[random.below(std::size(kWords))]);
}

inline void cut_end(std::string& bytes, Random& random) { bytes.resize(random.below(bytes.size())); }

inline void move_part(std::string& bytes, Random& random) {
  const std::string part = bytes.substr(random.below(bytes.size()), 1 + random.below(64));
  bytes.insert(random.below(bytes.size()), part);
}

/// One to three changes.
inline std::string mutated(std::string bytes, Random& random) {
  constexpr void (*kMutations[])(std::string&, Random&) = {flip_bit, set_byte, set_number, set_digits, cut_end, move_part};
  const std::uint64_t changes = 1 + random.below(3);
  for (std::uint64_t k = 0; k < changes && !bytes.empty(); ++k) kMutations[random.below(std::size(kMutations))](bytes, random);
  return bytes;
}

/// `read` accepts `bytes` and, after any change, loads or throws bad input in one line; some changes are noticed. `mend` follows every second change.
inline void expect_conforming(const std::string& bytes, const std::function<void(const std::string&)>& read, std::uint64_t seed,
                              const std::function<std::string(std::string_view)>& mend = {}) {
  ASSERT_NO_THROW(read(bytes)) << seed;
  Random random(seed);
  int refused = 0;
  for (int i = 0; i < mutation_count(); ++i) {
    std::string bad = mutated(bytes, random);
    if (mend && i % 2 == 0) bad = mend(bad);
    try {
      read(bad);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code(), ErrorCode::bad_input) << seed << ", change " << i << ": " << error.what();
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    } catch (const std::exception& error) {
      FAIL() << seed << ", change " << i << ": " << error.what();
    }
  }
  EXPECT_GT(refused, 0) << seed;
}

}  // namespace vantage
