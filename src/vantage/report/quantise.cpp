// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>

#include "vantage/report/png.h"

namespace vantage {

namespace {

constexpr std::size_t kColours = 256;

/// Pixels alike to 5 bits a colour channel and 3 bits of alpha.
struct Bin {
  std::array<std::uint8_t, 4> coarse{};
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t count = 0;
};

std::uint32_t pack(const std::uint8_t* p) {
  if (p[3] == 0) return 0;  // All invisible pixels are one.
  return static_cast<std::uint32_t>(p[0]) | static_cast<std::uint32_t>(p[1]) << 8 | static_cast<std::uint32_t>(p[2]) << 16 | static_cast<std::uint32_t>(p[3]) << 24;
}

std::array<std::uint8_t, 4> coarse(std::uint32_t c) {
  const auto byte = [c](int k) { return static_cast<std::uint8_t>(c >> (8 * k) & 255U); };
  return {static_cast<std::uint8_t>(byte(0) >> 3), static_cast<std::uint8_t>(byte(1) >> 3), static_cast<std::uint8_t>(byte(2) >> 3),
          static_cast<std::uint8_t>(byte(3) >> 5)};
}

std::size_t bin_of(std::uint32_t c) {
  const auto q = coarse(c);
  return static_cast<std::size_t>(q[0]) | static_cast<std::size_t>(q[1]) << 5 | static_cast<std::size_t>(q[2]) << 10 | static_cast<std::size_t>(q[3]) << 15;
}

/// A run of bins that will become one colour.
struct Cell {
  std::size_t begin = 0, end = 0;
  int axis = 0;
  std::uint64_t weight = 0;  ///< Pixels times extent: the next to be cut has most.
};

Cell measured(const std::vector<Bin>& bins, std::size_t begin, std::size_t end) {
  Cell cell{begin, end, 0, 0};
  std::uint64_t count = 0;
  for (std::size_t i = begin; i < end; ++i) count += bins[i].count;
  std::uint64_t widest = 0;
  for (int a = 0; a < 4; ++a) {
    std::uint8_t low = 255, high = 0;
    for (std::size_t i = begin; i < end; ++i) {
      low = std::min(low, bins[i].coarse[a]);
      high = std::max(high, bins[i].coarse[a]);
    }
    const std::uint64_t extent = static_cast<std::uint64_t>(high - low) * (a == 3 ? 4 : 1);
    if (extent > widest) {
      widest = extent;
      cell.axis = a;
    }
  }
  // The square root keeps rare colours from being swallowed by a large even ground.
  std::uint64_t root = 1;
  while (root * root < count) root *= 2;
  cell.weight = root * widest * widest;
  return cell;
}

/// Cuts the cell where half of its pixels lie on either side.
std::size_t cut(std::vector<Bin>& bins, const Cell& cell) {
  const auto first = bins.begin() + static_cast<std::ptrdiff_t>(cell.begin), last = bins.begin() + static_cast<std::ptrdiff_t>(cell.end);
  std::sort(first, last, [a = cell.axis](const Bin& x, const Bin& y) { return std::pair(x.coarse[a], x.coarse) < std::pair(y.coarse[a], y.coarse); });
  const std::uint64_t total = std::accumulate(first, last, std::uint64_t{0}, [](std::uint64_t n, const Bin& b) { return n + b.count; });
  std::uint64_t so_far = 0;
  for (std::size_t i = cell.begin; i + 1 < cell.end; ++i) {
    so_far += bins[i].count;
    if (2 * so_far >= total) return i + 1;
  }
  return cell.end - 1;
}

std::vector<Cell> median_cut(std::vector<Bin>& bins) {
  std::vector<Cell> cells{measured(bins, 0, bins.size())};
  while (cells.size() < kColours) {
    const auto most = std::max_element(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.weight < b.weight; });
    if (most->weight == 0) break;
    const Cell whole = *most;
    const std::size_t middle = cut(bins, whole);
    *most = measured(bins, whole.begin, middle);
    cells.push_back(measured(bins, middle, whole.end));
  }
  return cells;
}

std::vector<Bin> histogram(const std::vector<std::uint32_t>& pixels) {
  std::vector<Bin> all(std::size_t{1} << 18);
  for (const std::uint32_t c : pixels) {
    Bin& bin = all[bin_of(c)];
    bin.coarse = coarse(c);
    for (int k = 0; k < 4; ++k) bin.sum[k] += c >> (8 * k) & 255U;
    ++bin.count;
  }
  std::erase_if(all, [](const Bin& bin) { return bin.count == 0; });
  return all;
}

std::uint32_t mean(const std::vector<Bin>& bins, const Cell& cell) {
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t count = 0;
  for (std::size_t i = cell.begin; i < cell.end; ++i) {
    for (int k = 0; k < 4; ++k) sum[k] += bins[i].sum[k];
    count += bins[i].count;
  }
  std::uint32_t colour = 0;
  for (int k = 0; k < 4; ++k) colour |= static_cast<std::uint32_t>((sum[k] + count / 2) / count) << (8 * k);
  return colour;
}

/// The image's own colours, if there are few.
bool exact(const std::vector<std::uint32_t>& pixels, IndexedImage& result) {
  std::unordered_map<std::uint32_t, std::uint8_t> index;
  result.indices.reserve(pixels.size());
  for (const std::uint32_t c : pixels) {
    const auto [place, fresh] = index.try_emplace(c, static_cast<std::uint8_t>(result.palette.size()));
    if (fresh) {
      if (result.palette.size() == kColours) return false;
      result.palette.push_back(c);
    }
    result.indices.push_back(place->second);
  }
  return true;
}

}  // namespace

IndexedImage quantised(const Image& image) {
  std::vector<std::uint32_t> pixels(image.rgba.size() / 4);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = pack(&image.rgba[4 * i]);
  IndexedImage result{image.width, image.height, {}, {}};
  if (exact(pixels, result)) return result;

  std::vector<Bin> bins = histogram(pixels);
  const std::vector<Cell> cells = median_cut(bins);
  std::vector<std::uint8_t> index(std::size_t{1} << 18);
  result.palette.clear();
  for (const Cell& cell : cells) {
    for (std::size_t i = cell.begin; i < cell.end; ++i) {
      const auto& q = bins[i].coarse;
      index[static_cast<std::size_t>(q[0]) | static_cast<std::size_t>(q[1]) << 5 | static_cast<std::size_t>(q[2]) << 10 | static_cast<std::size_t>(q[3]) << 15] =
          static_cast<std::uint8_t>(result.palette.size());
    }
    result.palette.push_back(mean(bins, cell));
  }
  result.indices.resize(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) result.indices[i] = index[bin_of(pixels[i])];
  return result;
}

}  // namespace vantage
