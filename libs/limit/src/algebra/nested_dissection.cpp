// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "algebra/nested_dissection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace holdfast::limit {
namespace {

class Dissection {
 public:
  Dissection(std::span<const Eigen::Vector3d> places, std::span<const std::pair<int, int>> edges)
      : places_(places), neighbours_(places.size()), side_(places.size(), kOutside) {
    for (const auto& [a, b] : edges) {
      neighbours_[static_cast<std::size_t>(a)].push_back(b);
      neighbours_[static_cast<std::size_t>(b)].push_back(a);
      const double length =
          (places[static_cast<std::size_t>(a)] - places[static_cast<std::size_t>(b)]).norm();
      if (length > 0) {
        layer_ = std::min(layer_, kLayer * length);
      }
    }
  }

  std::vector<int> order() {
    std::vector<int> all(places_.size());
    std::iota(all.begin(), all.end(), 0);
    cut(std::move(all));
    return std::move(order_);
  }

 private:
  static constexpr char kOutside = 0;
  static constexpr char kLow = 1;
  static constexpr char kHigh = 2;
  /// Nodes that are not cut further: about what a front holds anyway.
  static constexpr std::size_t kFew = 6;
  /// Nodes nearer to each other than this share of the shortest edge lie in one layer.
  static constexpr double kLayer = 1.0 / 64;

  /// A plane that parts nodes: the first `low_count` of them in this order are on its low side.
  struct Plane {
    std::vector<int> nodes = {};
    std::size_t low_count = 0;
    bool cuts_low = false;  ///< The seam, which is taken out, is on the low side.
    double cost = std::numeric_limits<double>::infinity();
  };

  /// Layers of the lattices that there are lie across some of these.
  static inline const std::array<Eigen::Vector3d, 9> kDirections = {{{1, 0, 0},
                                                                     {0, 1, 0},
                                                                     {0, 0, 1},
                                                                     {1, 1, 0},
                                                                     {1, -1, 0},
                                                                     {1, 0, 1},
                                                                     {1, 0, -1},
                                                                     {0, 1, 1},
                                                                     {0, 1, -1}}};

  void cut(std::vector<int> nodes) {
    if (nodes.size() <= kFew) {
      order_.insert(order_.end(), nodes.begin(), nodes.end());
      return;
    }
    const Plane plane = best_plane(nodes);
    if (plane.nodes.empty()) {  // Each touches all.
      order_.insert(order_.end(), nodes.begin(), nodes.end());
      return;
    }
    nodes = {};
    std::vector<int> low;
    std::vector<int> high;
    std::vector<int> seam;
    mark_sides(plane);
    for (std::size_t i = 0; i < plane.nodes.size(); ++i) {
      const bool is_low = i < plane.low_count;
      const bool is_seam =
          is_low == plane.cuts_low && touches(plane.nodes[i], is_low ? kHigh : kLow);
      (is_seam ? seam : is_low ? low : high).push_back(plane.nodes[i]);
    }
    unmark(plane);
    cut(std::move(low));
    cut(std::move(high));
    order_.insert(order_.end(), seam.begin(), seam.end());
  }

  /// The plane with the least seam for the size of the smaller part, of those that halve the nodes
  /// along any direction, and of those beside them that cut no layer.
  Plane best_plane(const std::vector<int>& nodes) {
    Plane best;
    for (const Eigen::Vector3d& direction : kDirections) {
      const std::vector<Seat> seats = sorted_along(direction, nodes);
      Plane plane;
      for (const Seat& seat : seats) {
        plane.nodes.push_back(seat.node);
      }
      const std::size_t half = nodes.size() / 2;
      const std::int64_t layer = seats[half].along;
      const auto below = std::ranges::lower_bound(seats, layer, {}, &Seat::along);
      const auto above = std::ranges::upper_bound(seats, layer, {}, &Seat::along);
      for (const auto low_count :
           {static_cast<std::ptrdiff_t>(half), below - seats.begin(), above - seats.begin()}) {
        plane.low_count = static_cast<std::size_t>(low_count);
        weigh(plane);
        if (plane.cost < best.cost) {
          best = plane;
        }
      }
    }
    return best;
  }

  /// A node's layer along a direction, and its place within the layer.
  struct Seat {
    std::int64_t along;
    std::int64_t across;
    int node;

    auto operator<=>(const Seat&) const = default;
  };

  std::vector<Seat> sorted_along(const Eigen::Vector3d& direction,
                                 const std::vector<int>& nodes) const {
    const Eigen::Vector3d across = {direction[2], direction[0], direction[1]};
    std::vector<Seat> seats;
    seats.reserve(nodes.size());
    for (const int node : nodes) {
      const Eigen::Vector3d& place = places_[static_cast<std::size_t>(node)];
      seats.push_back({.along = std::llround(direction.dot(place) / layer_),
                       .across = std::llround(across.dot(place) / layer_),
                       .node = node});
    }
    std::ranges::sort(seats);
    return seats;
  }

  /// Sets the smaller seam and the cost of a plane; one with nothing on a side costs infinity.
  void weigh(Plane& plane) {
    mark_sides(plane);
    std::size_t low_seam = 0;
    std::size_t high_seam = 0;
    for (std::size_t i = 0; i < plane.nodes.size(); ++i) {
      if (i < plane.low_count) {
        low_seam += touches(plane.nodes[i], kHigh) ? 1 : 0;
      } else {
        high_seam += touches(plane.nodes[i], kLow) ? 1 : 0;
      }
    }
    unmark(plane);
    plane.cuts_low = low_seam < high_seam;
    const std::size_t low = plane.low_count - (plane.cuts_low ? low_seam : 0);
    const std::size_t high =
        plane.nodes.size() - plane.low_count - (plane.cuts_low ? 0 : high_seam);
    plane.cost = static_cast<double>(std::min(low_seam, high_seam)) /
                 static_cast<double>(std::min(low, high));
    if (std::min(low, high) == 0) {
      plane.cost = std::numeric_limits<double>::infinity();
    }
  }

  void mark_sides(const Plane& plane) {
    for (std::size_t i = 0; i < plane.nodes.size(); ++i) {
      side_[static_cast<std::size_t>(plane.nodes[i])] = i < plane.low_count ? kLow : kHigh;
    }
  }

  void unmark(const Plane& plane) {
    for (const int node : plane.nodes) {
      side_[static_cast<std::size_t>(node)] = kOutside;
    }
  }

  bool touches(int node, char side) const {
    return std::ranges::any_of(neighbours_[static_cast<std::size_t>(node)], [&](int other) {
      return side_[static_cast<std::size_t>(other)] == side;
    });
  }

  std::span<const Eigen::Vector3d> places_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<char> side_;
  double layer_ = std::numeric_limits<double>::infinity();
  std::vector<int> order_;
};

}  // namespace

std::vector<int> nested_dissection(std::span<const Eigen::Vector3d> places,
                                   std::span<const std::pair<int, int>> edges) {
  return Dissection(places, edges).order();
}

}  // namespace holdfast::limit
