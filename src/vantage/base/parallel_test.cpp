// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace vantage {
namespace {

TEST(Parallel, EveryIndexOnce) {
  for (const std::size_t count : {0U, 1U, 7U, 1000U})
    for (const std::size_t chunk : {1U, 3U, 1000U, 5000U}) {
      std::vector<std::atomic<int>> seen(count);
      parallel_for(count, chunk, [&](std::size_t i) { ++seen[i]; });
      for (const auto& n : seen) EXPECT_EQ(n, 1);
    }
}

TEST(Parallel, ChunksAreFixed) {
  std::vector<std::atomic<int>> ends(101);
  parallel_chunks(100, 8, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin % 8, 0U);
    EXPECT_EQ(end, std::min<std::size_t>(100, begin + 8));
    ++ends[end];
  });
  EXPECT_EQ(ends[100], 1);
}

TEST(Parallel, ReduceHasTheSameBitsForAnyThreads) {
  const auto sum = [] {
    return parallel_reduce(
        100000, 64, 0.0,
        [](std::size_t begin, std::size_t end) {
          double part = 0.0;
          for (std::size_t i = begin; i < end; ++i) part += 1.0 / (1.0 + static_cast<double>(i));
          return part;
        },
        [](double& total, double part) { total += part; });
  };
  const double expected = sum();
  EXPECT_NEAR(expected, std::log(1e5) + 0.5772156649, 1e-4);
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(sum(), expected);
  }
}

TEST(Parallel, ReduceOfNothingIsTheStart) {
  EXPECT_EQ(parallel_reduce(0, 8, 42, [](std::size_t, std::size_t) { return 1; }, [](int& total, int part) { total += part; }), 42);
}

TEST(Parallel, LimitOfOneIsOneThread) {
  const ThreadLimit limit(1);
  const auto here = std::this_thread::get_id();
  parallel_for(200, 1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), here); });
}

TEST(Parallel, ErrorsComeThrough) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t i) {
                              if (i == 50) throw std::runtime_error("no");
                            }),
               std::runtime_error);
}

TEST(Parallel, Nests) {
  std::atomic<int> count = 0;
  parallel_for(8, 1, [&](std::size_t) { parallel_for(8, 1, [&](std::size_t) { ++count; }); });
  EXPECT_EQ(count, 64);
}

}  // namespace
}  // namespace vantage
