// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/small_scenes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "vantage/base/random.h"
#include "vantage/field/grid.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/world/blocks.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

constexpr double kCell = 0.5;        // Lattice spacing [m].
constexpr double kClearance = 0.55;  // Doors of two cells are too narrow, those of three are not [m].
constexpr std::array<std::string_view, 11> kNames{"box",  "field",     "pillar", "clutter", "doors",    "rooms",
                                                  "maze", "corridors", "voids",  "shut",    "symmetric"};

template <int Dim>
constexpr double kSide = 40.0 - 10.0 * Dim;  // Of the domain [m].

/// A scene while it is built: solid blocks, and the boxes one may start in.
template <int Dim>
class Builder {
 public:
  Builder(SmallKind kind, std::uint64_t seed) : kind_(kind), random_(seed, static_cast<std::uint64_t>(kind) * 8 + Dim) {
    domain_ = {Vec<Dim>::Zero(), Vec<Dim>::Constant(kSide<Dim>)};
  }

  Scene<Dim> build() {
    lay_out();
    Scene<Dim> scene;
    scene.name = std::string(kNames[static_cast<std::size_t>(kind_)]);
    const Vec<Dim> middle = domain_.center();
    const bool straight = kind_ == SmallKind::symmetric || kind_ == SmallKind::maze || kind_ == SmallKind::corridors;
    const bool turned = !straight && random_.uniform() < 0.3;
    Placement<Dim> place = Placement<Dim>{middle}.at(Vec<Dim>::Zero(), turned ? random_.uniform(-0.5, 0.5) : 0.0);
    place = place.at(-middle);
    blocks_.append_to(scene.mesh, place);
    scene.domain = domain_;
    scene.voxel = kCell;
    scene.eta = 0.1;
    scene.range = random_.uniform() < 0.8 || kind_ == SmallKind::symmetric ? 3.0 * kSide<Dim> : random_.uniform(0.3, 1.0) * kSide<Dim>;
    scene.clearance = kClearance;
    scene.start = start(scene.mesh, place);
    return scene;
  }

 private:
  double cells(double low, double high) { return kCell * random_.uniform(low, high); }
  bool chance(double share) { return random_.uniform() < share; }

  /// A random box of edges between `low` and `high` cells inside `within`.
  Box<Dim> box_in(const Box<Dim>& within, double low, double high) {
    Box<Dim> box;
    for (int a = 0; a < Dim; ++a) {
      const double room = within.size()[a], edge = std::min(cells(low, high), room);
      box.low[a] = within.low[a] + random_.uniform(0.0, room - edge);
      box.high[a] = box.low[a] + edge;
    }
    return box;
  }

  /// The outer walls: solid beyond the domain, or a shell with open land round it.
  Box<Dim> hull() {
    const Box<Dim> inner = domain_.grown(-cells(1.0, 3.0));
    blocks_.fill(chance(0.6) ? domain_.grown(1.0) : inner.grown(cells(0.4, 1.0)));
    return inner;
  }

  void room(const Box<Dim>& box) {
    blocks_.carve(box);
    rooms_.push_back(box);
  }

  void lay_out() {
    switch (kind_) {
      case SmallKind::box: room(box_in(hull(), 8.0, 40.0)); break;
      case SmallKind::field: field(); break;
      case SmallKind::pillar: pillar(); break;
      case SmallKind::clutter: clutter(); break;
      case SmallKind::doors: doors(); break;
      case SmallKind::rooms: divided(1.0); break;
      case SmallKind::maze: maze(7.0, 4.4, 5.6); break;
      case SmallKind::corridors: maze(5.0, 3.25, 3.6); break;
      case SmallKind::voids: divided(0.6); break;
      case SmallKind::shut: divided(0.0); break;
      case SmallKind::symmetric: symmetric(); break;
    }
  }

  void field() {
    rooms_.push_back(domain_);
    if (chance(0.7)) return;
    Box<Dim> slab = domain_;
    slab.high[Dim - 1] = kCell;
    slab.low[Dim - 1] = -kCell;
    blocks_.fill(slab.grown(cells(0.0, 4.0)));
  }

  void pillar() {
    if (chance(0.5))
      room(hull());
    else
      rooms_.push_back(domain_);
    Box<Dim> solid = box_in(domain_.grown(-2.0), 0.5, 8.0);
    if (chance(0.5)) {  // From end to end.
      solid.low[Dim - 1] = -1.0;
      solid.high[Dim - 1] = kSide<Dim> + 1.0;
    }
    blocks_.fill(solid);
  }

  void clutter() {
    if (chance(0.5))
      room(hull());
    else
      rooms_.push_back(domain_);
    const auto count = 3 + random_.below(26 - 4 * Dim);
    for (std::uint64_t k = 0; k < count; ++k) blocks_.fill(box_in(domain_.grown(-1.0), 0.4, chance(0.2) ? 12.0 : 5.0));
  }

  /// A wall across the box with a hole of 1 to 5 cells; the parts on both sides.
  std::array<Box<Dim>, 2> divide(const Box<Dim>& box, int axis, double share) {
    const double at = box.low[axis] + share * box.size()[axis], thick = cells(0.4, chance(0.5) ? 0.8 : 2.0);
    std::array<Box<Dim>, 2> parts{box, box};
    parts[0].high[axis] = at - 0.5 * thick;
    parts[1].low[axis] = at + 0.5 * thick;
    return parts;
  }

  Box<Dim> door(const std::array<Box<Dim>, 2>& parts, int axis) {
    const double width = kCell * static_cast<double>(1 + random_.below(5)), height = chance(0.5) ? width : kCell * 5.0;
    Box<Dim> hole = parts[0];
    for (int a = 0; a < Dim; ++a) {
      const double edge = std::min(a == Dim - 1 ? height : width, hole.size()[a]);
      hole.low[a] += random_.uniform(0.0, hole.size()[a] - edge);
      hole.high[a] = hole.low[a] + edge;
    }
    hole.low[axis] = parts[0].high[axis] - 1e-3;
    hole.high[axis] = parts[1].low[axis] + 1e-3;
    return hole;
  }

  void doors() {
    const Box<Dim> inner = hull();
    const int axis = static_cast<int>(random_.below(Dim));
    const auto parts = divide(inner, axis, random_.uniform(0.3, 0.7));
    for (const Box<Dim>& part : parts) room(part);
    blocks_.carve(door(parts, axis));
  }

  /// Divides the building; a door with the given probability in each wall.
  void divided(double doors) {
    std::vector<Box<Dim>> holes;
    const std::function<void(const Box<Dim>&)> split = [&](const Box<Dim>& box) {
      int axis = 0;
      box.size().maxCoeff(&axis);
      if (box.size()[axis] < 13.0 * kCell || (box.size()[axis] < 25.0 * kCell && chance(0.2))) return room(box);
      const auto parts = divide(box, axis, random_.uniform(0.35, 0.65));
      if (chance(doors)) holes.push_back(door(parts, axis));
      for (const Box<Dim>& part : parts) split(part);
    };
    split(hull());
    for (const Box<Dim>& hole : holes) blocks_.carve(hole);
  }

  /// A tree of passages over a lattice of chambers `pitch` cells apart, and a few passages more.
  void maze(double pitch, double narrow, double wide) {
    const double width = cells(narrow, wide), step = kCell * pitch, margin = kCell * 2.0;
    Grid<Dim> chambers;
    chambers.extent.setConstant(static_cast<std::int32_t>((kSide<Dim> - 2.0 * margin + step - width) / step));
    blocks_.fill(domain_.grown(1.0));
    const auto chamber = [&](std::size_t i) {
      const Vec<Dim> low = (chambers.local(i).template cast<double>() * step).array() + margin;
      return Box<Dim>{low, low.array() + width};
    };
    std::vector<std::size_t> trunk{random_.below(chambers.size())};
    std::vector<std::uint8_t> dug(chambers.size());
    dug[trunk[0]] = 1;
    room(chamber(trunk[0]));
    while (!trunk.empty()) {
      std::vector<std::size_t> next;
      const Index<Dim> at = chambers.local(trunk.back());
      for (int a = 0; a < Dim; ++a)
        for (const int by : {-1, 1}) {
          const Index<Dim> to = at + by * Index<Dim>::Unit(a);
          if (chambers.inside(to) && (dug[chambers.linear(to)] == 0 || chance(0.02))) next.push_back(chambers.linear(to));
        }
      if (next.empty() || chance(0.03)) {
        trunk.pop_back();
        continue;
      }
      const std::size_t to = next[random_.below(next.size())];
      Box<Dim> way = chamber(trunk.back());
      way.extend(chamber(to));
      blocks_.carve(way);
      if (dug[to] == 0) trunk.push_back(to);
      dug[to] = 1;
    }
  }

  void symmetric() {
    const Vec<Dim> middle = domain_.center();
    const Box<Dim> inner = hull();
    blocks_.carve(inner);
    const auto count = 1 + random_.below(3);
    for (std::uint64_t k = 0; k < count; ++k) {
      Box<Dim> part{middle.array() + 2.0 * kCell, domain_.high.array() - 3.0 * kCell};
      part = box_in(part, 1.0, 6.0);
      for (int mirrored = 0; mirrored < (1 << Dim); ++mirrored) {
        Box<Dim> image = part;
        for (int a = 0; a < Dim; ++a)
          if ((mirrored >> a & 1) != 0) {
            image.low[a] = 2.0 * middle[a] - part.high[a];
            image.high[a] = 2.0 * middle[a] - part.low[a];
          }
        blocks_.fill(image);
      }
    }
    rooms_.push_back({middle, middle});
  }

  /// A place in one of the rooms with a cell more than the clearance round it, or with less, down to the clearance, if there is none; nothing there
  /// is solid.
  Vec<Dim> start(const Mesh<Dim>& mesh, const Placement<Dim>& place) {
    const RayCaster<Dim> caster(mesh);
    double room = kClearance + kCell;
    for (int attempt = 0;; ++attempt, room = std::max(0.995 * room, attempt < 20000 ? 1.001 * kClearance : 0.0)) {
      const Box<Dim>& box = rooms_[random_.below(rooms_.size())];
      Vec<Dim> at;
      for (int a = 0; a < Dim; ++a) at[a] = random_.uniform(box.low[a], box.high[a]);
      const Vec<Dim> p = place(at);
      if (!domain_.contains(p) || caster.distance(p, 2.0 * room) < room || inside_solid(caster, p)) continue;
      return p;
    }
  }

  SmallKind kind_;
  Random random_;
  Box<Dim> domain_;
  Blocks<Dim> blocks_;
  std::vector<Box<Dim>> rooms_;
};

}  // namespace

std::span<const std::string_view> small_kinds() { return kNames; }

template <int Dim>
Scene<Dim> make_small_scene(SmallKind kind, std::uint64_t seed) {
  return Builder<Dim>(kind, seed).build();
}

template Scene<2> make_small_scene<2>(SmallKind, std::uint64_t);
template Scene<3> make_small_scene<3>(SmallKind, std::uint64_t);

}  // namespace vantage
