// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage {

namespace {

constexpr double kUnits = 20.0;              ///< Of a letter in its size.
constexpr double kSpacing = 3.6;             ///< Between letters [units].
constexpr double kThin = 1.75, kBold = 2.7;  ///< Strokes [units].

double distance_to_piece(const Vec<2>& p, const Vec<2>& a, const Vec<2>& b) {
  const Vec<2> along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

double distance_to_line(const Vec<2>& p, std::span<const Vec<2>> line) {
  double nearest = (p - line.front()).norm();
  for (std::size_t i = 1; i < line.size(); ++i) nearest = std::min(nearest, distance_to_piece(p, line[i - 1], line[i]));
  return nearest;
}

bool inside(const Vec<2>& p, std::span<const Vec<2>> corners) {
  bool in = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vec<2>&a = corners[i], &b = corners[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) in = !in;
  }
  return in;
}

struct Extent {
  Vec<2> low = Vec<2>::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(std::span<const Vec<2>> line) {
    for (const Vec<2>& p : line) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
};

/// The characters of a UTF-8 text; broken sequences give U+FFFD.
std::vector<char32_t> decoded(std::string_view text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
    if (length == 0 || i + length > text.size()) {
      codes.push_back(0xfffd);
      ++i;
      continue;
    }
    char32_t code = length == 1 ? lead : lead & (0x7fU >> length);
    for (std::size_t k = 1; k < length; ++k) code = code << 6U | (static_cast<unsigned char>(text[i + k]) & 0x3fU);
    codes.push_back(code);
    i += length;
  }
  return codes;
}

}  // namespace

Canvas::Canvas(int width, int height, Rgb ground) : image_(width, height) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image_.set(x, y, ground);
}

template <class Cover>
void Canvas::mix_in(const Vec<2>& low, const Vec<2>& high, Rgb colour, const Cover& cover) {
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v))); };
  const auto last = [](double v, int size) { return std::min(size - 1, static_cast<int>(std::ceil(v))); };
  for (int y = first(low.y()); y <= last(high.y(), image_.height); ++y) {
    for (int x = first(low.x()); x <= last(high.x(), image_.width); ++x) {
      const double share = std::clamp(cover(Vec<2>(x + 0.5, y + 0.5)), 0.0, 1.0);
      if (share <= 0.0) continue;
      const std::uint8_t* p = image_.pixel(x, y);
      const Rgb below{p[0], p[1], p[2]};
      const double kept = p[3] / 255.0 * (1.0 - share), alpha = share + kept;
      image_.set(x, y, mix(below, colour, share / alpha), static_cast<std::uint8_t>(std::lround(alpha * 255.0)));
    }
  }
}

void Canvas::stroke(std::span<const Vec<2>> line, double width, Rgb colour, double opacity) {
  if (line.empty()) return;
  Extent extent;
  extent.add(line);
  const Vec<2> rim = Vec<2>::Constant(0.5 * width + 1.0);
  mix_in(extent.low - rim, extent.high + rim, colour,
         [&](const Vec<2>& p) { return opacity * std::min(1.0, 0.5 * width + 0.5 - distance_to_line(p, line)); });
}

void Canvas::dashes(std::span<const Vec<2>> line, double width, double dash, Rgb colour) {
  double travelled = 0.0;  // Modulo a dash and its gap.
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = (line[i] - line[i - 1]).norm();
    for (double at = 0.0; at < length;) {
      const bool drawn = travelled < dash;
      const double step = std::min((drawn ? dash : 1.5 * dash) - travelled + 1e-9, length - at);
      const auto place = [&](double s) -> Vec<2> { return line[i - 1] + s / length * (line[i] - line[i - 1]); };
      const std::array<Vec<2>, 2> piece{place(at), place(at + step)};
      if (drawn) stroke(piece, width, colour);
      at += step;
      travelled = travelled + step >= 1.5 * dash ? 0.0 : travelled + step;
    }
  }
}

void Canvas::area(std::span<const Vec<2>> corners, Rgb colour, double opacity) {
  if (corners.size() < 3) return;
  std::vector<Vec<2>> ring(corners.begin(), corners.end());
  ring.push_back(ring.front());
  Extent extent;
  extent.add(ring);
  mix_in(extent.low - Vec<2>::Ones(), extent.high + Vec<2>::Ones(), colour, [&](const Vec<2>& p) {
    const double rim = distance_to_line(p, ring);
    return opacity * std::min(1.0, inside(p, corners) ? 0.5 + rim : 0.5 - rim);
  });
}

void Canvas::rectangle(const Vec<2>& low, const Vec<2>& high, Rgb colour, double opacity) {
  mix_in(low, high, colour, [&](const Vec<2>& p) {
    const Vec<2> rim = (p - low).cwiseMin(high - p);
    return opacity * std::clamp(rim.x() + 0.5, 0.0, 1.0) * std::clamp(rim.y() + 0.5, 0.0, 1.0);
  });
}

void Canvas::lay(const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = picture.pixel(x, y);
      const Vec<2> here(left + x, top + y);
      mix_in(here + Vec<2>::Constant(0.4), here + Vec<2>::Constant(0.4), {p[0], p[1], p[2]},
             [&](const Vec<2>& q) { return (q - here).maxCoeff() < 1.0 && (q - here).minCoeff() > 0.0 ? p[3] / 255.0 : 0.0; });
    }
  }
}

void Canvas::text(const Vec<2>& at, std::string_view text, const Lettering& lettering) {
  const double unit = lettering.size / kUnits, width = (lettering.bold ? kBold : kThin) * unit;
  double pen = 0.0;
  if (lettering.align == Lettering::Align::middle) pen = -0.5 * text_width(text, lettering);
  if (lettering.align == Lettering::Align::right) pen = -text_width(text, lettering);
  for (const char32_t code : decoded(text)) {
    const Glyph& letter = glyph(code);
    std::vector<std::vector<Vec<2>>> strokes = letter.strokes;
    Extent extent;
    for (auto& line : strokes) {
      for (Vec<2>& p : line) {
        const Vec<2> q(pen + unit * p.x(), -unit * p.y());
        p = lettering.upwards ? at + Vec<2>(q.y(), -q.x()) : at + q;
      }
      extent.add(line);
    }
    const Vec<2> rim = Vec<2>::Constant(0.5 * width + 1.0);
    if (!strokes.empty()) {
      mix_in(extent.low - rim, extent.high + rim, lettering.colour, [&](const Vec<2>& p) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& line : strokes) nearest = std::min(nearest, distance_to_line(p, line));
        return 0.5 * width + 0.5 - nearest;
      });
    }
    pen += unit * (letter.width + kSpacing);
  }
}

double text_width(std::string_view text, const Lettering& lettering) {
  double width = 0.0;
  for (const char32_t code : decoded(text)) width += glyph(code).width + kSpacing;
  return std::max(0.0, width - kSpacing) * lettering.size / kUnits;
}

}  // namespace vantage
