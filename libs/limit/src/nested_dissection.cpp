// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "nested_dissection.hpp"

#include <algorithm>
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

  void cut(std::vector<int> nodes) {
    if (nodes.size() <= kFew) {
      order_.insert(order_.end(), nodes.begin(), nodes.end());
      return;
    }
    const auto middle = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
    const Eigen::Index axis = longest_side(nodes);
    std::ranges::sort(nodes, [&](int a, int b) { return before(a, b, axis); });
    for (auto node = nodes.begin(); node != nodes.end(); ++node) {
      side_[static_cast<std::size_t>(*node)] = node < middle ? kLow : kHigh;
    }
    // Nodes of the smaller of the two seams part the halves.
    std::vector<int> low;
    std::vector<int> high;
    std::vector<int> low_seam;
    std::vector<int> high_seam;
    for (const int node : nodes) {
      const bool is_low = side_[static_cast<std::size_t>(node)] == kLow;
      const bool is_seam = touches(node, is_low ? kHigh : kLow);
      (is_low ? (is_seam ? low_seam : low) : (is_seam ? high_seam : high)).push_back(node);
    }
    for (const int node : nodes) {
      side_[static_cast<std::size_t>(node)] = kOutside;
    }
    const bool cuts_low = low_seam.size() < high_seam.size();
    std::vector<int>& kept = cuts_low ? high : low;
    const std::vector<int>& beside = cuts_low ? high_seam : low_seam;
    kept.insert(kept.end(), beside.begin(), beside.end());
    const std::vector<int> seam = std::move(cuts_low ? low_seam : high_seam);
    nodes = {};
    cut(std::move(low));
    cut(std::move(high));
    order_.insert(order_.end(), seam.begin(), seam.end());
  }

  Eigen::Index longest_side(const std::vector<int>& nodes) const {
    Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array3d high = -low;
    for (const int node : nodes) {
      low = low.min(places_[static_cast<std::size_t>(node)].array());
      high = high.max(places_[static_cast<std::size_t>(node)].array());
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
  }

  /// Along the axis, then along the others: a straight cut with one step in it.
  bool before(int a, int b, Eigen::Index axis) const {
    const Eigen::Vector3d& first = places_[static_cast<std::size_t>(a)];
    const Eigen::Vector3d& second = places_[static_cast<std::size_t>(b)];
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index k = (axis + i) % 3;
      if (first[k] != second[k]) {
        return first[k] < second[k];
      }
    }
    return a < b;
  }

  bool touches(int node, char side) const {
    return std::ranges::any_of(neighbours_[static_cast<std::size_t>(node)], [&](int other) {
      return side_[static_cast<std::size_t>(other)] == side;
    });
  }

  std::span<const Eigen::Vector3d> places_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<char> side_;
  std::vector<int> order_;
};

}  // namespace

std::vector<int> nested_dissection(std::span<const Eigen::Vector3d> places,
                                   std::span<const std::pair<int, int>> edges) {
  return Dissection(places, edges).order();
}

}  // namespace holdfast::limit
