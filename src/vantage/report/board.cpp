// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/board.h"

#include <algorithm>
#include <array>

namespace vantage {

namespace {

constexpr Rgb kWhite{255, 255, 255};
constexpr int kMargin = 24, kGap = 14, kNameWidth = 34, kCaptionHeight = 30;
constexpr double kTitleSize = 27.0, kTextSize = 18.0, kNoteLine = 25.0;
constexpr double kSignWidth = 28.0, kKeyGap = 30.0, kKeyLine = 32.0, kRampWidth = 110.0;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

int name_width(const Board& board) {
  return std::ranges::any_of(board.rows, [](const Board::Row& row) { return !row.name.empty(); }) ? kNameWidth : 0;
}

struct RowSize {
  int width = 0, height = 0;
};

RowSize size_of(const Board::Row& row) {
  RowSize size{-kGap, 0};
  bool words = false;
  for (const Tile& tile : row.tiles) {
    size.width += tile.image.width + kGap;
    size.height = std::max(size.height, tile.image.height);
    words = words || !tile.caption.empty();
  }
  size.height += words ? kCaptionHeight : 0;
  return size;
}

double key_width(const Key& key) {
  const double before = key.before.empty() ? 0.0 : text_width(key.before, {kTextSize}) + 10.0;
  return before + (key.sign == Key::Sign::ramp ? kRampWidth : kSignWidth) + 10.0 + text_width(key.text, {kTextSize});
}

void draw_area(Canvas& canvas, const Key& key, const Vec<2>& middle) {
  const Vec<2> half(12.0, 9.0);
  canvas.rectangle(middle - half, middle + half, kSoftInk, 0.6);
  canvas.rectangle(middle - half + Vec<2>::Ones(), middle + half - Vec<2>::Ones(), key.colour);
  if (key.sign != Key::Sign::hatch) return;
  for (double x = -6.0; x <= 8.0; x += 7.0) {
    const std::array<Vec<2>, 2> line{middle + Vec<2>(x - 5.0, 7.0), middle + Vec<2>(x + 3.0, -7.0)};
    canvas.stroke(line, 1.6, mix(key.colour, kSoftInk, 0.6));
  }
}

/// A sign in the middle of its place.
void draw_sign(Canvas& canvas, const Key& key, const Vec<2>& middle) {
  const std::array<Vec<2>, 2> line{middle - Vec<2>(13.0, 0.0), middle + Vec<2>(13.0, 0.0)};
  const std::array<Vec<2>, 1> spot{middle};
  switch (key.sign) {
    case Key::Sign::area:
    case Key::Sign::hatch: draw_area(canvas, key, middle); break;
    case Key::Sign::line: canvas.stroke(line, 3.0, key.colour); break;
    case Key::Sign::dashed: canvas.dashes(line, 2.4, 6.0, key.colour); break;
    case Key::Sign::dot: canvas.stroke(spot, 12.0, key.colour); break;
    case Key::Sign::diamond: draw_diamond(canvas, middle, 8.0); break;
    case Key::Sign::cross: draw_cross(canvas, middle, 8.0); break;
    case Key::Sign::pin: draw_pin(canvas, middle, 1, 10.0); break;
    case Key::Sign::ramp: break;
  }
}

void draw_ramp(Canvas& canvas, const Key& key, const Vec<2>& left) {
  for (int x = 0; x < static_cast<int>(kRampWidth); ++x) {
    const double t = std::round(64.0 * x / kRampWidth) / 64.0;
    canvas.rectangle(left + Vec<2>(x, -7.0), left + Vec<2>(x + 1.0, 7.0), colour_of(key.map, key.map_low + (1.0 - key.map_low) * t));
  }
}

void draw_key(Canvas& canvas, const Key& key, Vec<2> at) {
  const Vec<2> drop(0.0, 0.34 * kTextSize);
  if (!key.before.empty()) {
    canvas.text(at + drop, key.before, {kTextSize, kInk});
    at.x() += text_width(key.before, {kTextSize}) + 10.0;
  }
  const bool ramp = key.sign == Key::Sign::ramp;
  if (ramp)
    draw_ramp(canvas, key, at);
  else
    draw_sign(canvas, key, at + Vec<2>(0.5 * kSignWidth, 0.0));
  canvas.text(at + Vec<2>((ramp ? kRampWidth : kSignWidth) + 10.0, 0.0) + drop, key.text, {kTextSize, kInk});
}

/// Where each key begins and which line it stands on, for a legend so wide.
struct Placed {
  std::vector<Vec<2>> at;
  double height = 0.0;
};

Placed placed(const std::vector<Key>& legend, double width) {
  Placed result;
  double x = 0.0, y = 0.0;
  for (const Key& key : legend) {
    if (x > 0.0 && x + key_width(key) > width) {
      x = 0.0;
      y += kKeyLine;
    }
    result.at.emplace_back(x, y);
    x += key_width(key) + kKeyGap;
  }
  result.height = legend.empty() ? 0.0 : y + kKeyLine;
  return result;
}

}  // namespace

Image board_image(const Board& board) {
  const std::vector<std::string> notes = lines_of(board.note);
  const int names = name_width(board);
  double inner = text_width(board.title, {kTitleSize});
  int rows = 0;
  for (const std::string& line : notes) inner = std::max(inner, text_width(line, {kTextSize}));
  for (const Board::Row& row : board.rows) {
    inner = std::max(inner, static_cast<double>(names + size_of(row).width));
    rows += size_of(row).height + kGap;
  }
  const Placed legend = placed(board.legend, inner);
  const double head = (board.title.empty() ? 0.0 : kTitleSize + 12.0) + static_cast<double>(notes.size()) * kNoteLine + (notes.empty() ? 0.0 : 6.0);
  Canvas canvas(static_cast<int>(inner) + 2 * kMargin, static_cast<int>(head + legend.height) + rows + 2 * kMargin - kGap + 10, kWhite);

  double y = kMargin;
  if (!board.title.empty()) {
    canvas.text({kMargin, y + 0.75 * kTitleSize}, board.title, {kTitleSize, kInk, Lettering::Align::left, true});
    y += kTitleSize + 12.0;
  }
  for (const std::string& line : notes) {
    canvas.text({kMargin, y + 0.7 * kTextSize}, line, {kTextSize, kSoftInk});
    y += kNoteLine;
  }
  if (!notes.empty()) y += 6.0;
  for (const Board::Row& row : board.rows) {
    const RowSize size = size_of(row);
    int x = kMargin + names, tallest = 0;
    for (const Tile& tile : row.tiles) tallest = std::max(tallest, tile.image.height);
    if (!row.name.empty())
      canvas.text({kMargin + 0.7 * kTextSize, y + 0.5 * tallest}, row.name, {kTextSize, kInk, Lettering::Align::middle, false, true});
    for (const Tile& tile : row.tiles) {
      canvas.lay(tile.image, x, static_cast<int>(y));
      canvas.text({x + 0.5 * tile.image.width, y + tallest + 22.0}, tile.caption, {kTextSize, kSoftInk, Lettering::Align::middle});
      x += tile.image.width + kGap;
    }
    y += size.height + kGap;
  }
  y += 8.0;
  for (std::size_t i = 0; i < board.legend.size(); ++i) draw_key(canvas, board.legend[i], Vec<2>(kMargin, y + 0.3 * kKeyLine) + legend.at[i]);
  return canvas.image();
}

}  // namespace vantage
