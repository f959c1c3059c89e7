// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "anchors.hpp"

#include <algorithm>

namespace holdfast::solver {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

Anchor beam_anchor(const model::Material& material, std::size_t node, std::size_t direction,
                   std::size_t length) {
  const Spring spring = beam_spring(material, direction, length);
  return {.node = static_cast<std::int32_t>(node),
          .direction = spring.direction,
          .length = spring.length,
          .reach = spring.length,
          .middle = spring.middle,
          .stiffness = spring.stiffness};
}

/// An anchor of a member as its cluster has it.
template <class Real>
Anchor moved(Anchor anchor, const Seat<Real>& seat) {
  const Point arm = offset(seat);
  anchor.node = seat.cluster;
  anchor.reach += behind(arm, anchor.direction);
  anchor.stiffness = carried(anchor.stiffness, arm);
  for (std::size_t k = 0; k < 3; ++k) {
    anchor.middle[k] += arm[k];
  }
  return anchor;
}

bool are_alike(const Anchor& a, const Anchor& b) {
  return a.node == b.node && a.direction == b.direction;
}

/// Anchors of one cluster in one direction as a single one.
Anchor united(const Anchor* first, const Anchor* last) {
  Anchor sum = *first;
  for (const Anchor* anchor = first + 1; anchor != last; ++anchor) {
    base::add_to(sum.stiffness, anchor->stiffness);
    sum.length += anchor->length;
    sum.reach += anchor->reach;
    for (std::size_t k = 0; k < 3; ++k) {
      sum.middle[k] += anchor->middle[k];
    }
  }
  const auto count = static_cast<double>(last - first);
  for (double& x : sum.middle) {
    x /= count;
  }
  sum.reach /= count;
  sum.stiffness =
      stretched(sum.stiffness, sum.middle, sum.direction / 2U, sum.length / count, sum.reach);
  sum.length = sum.reach;
  return sum;
}

}  // namespace

std::vector<Anchor> finest_anchors(const Network& network, const model::Material& material,
                                   const GroundStiffness& ground) {
  constexpr std::size_t kDown = base::index(base::Direction::kMinusZ);
  std::vector<Anchor> anchors;
  for (std::size_t node = 0; node < network.node_count; ++node) {
    const Kind& kind = network.kind[node];
    for (std::size_t d = 0; d < 6; ++d) {
      if (kind[d] > 0 && at(network.other[node][d]) >= network.node_count) {
        anchors.push_back(beam_anchor(material, node, d, kind[d]));
      }
    }
    if (kind[kContactByte] != 0) {
      anchors.push_back(beam_anchor(material, node, kDown, 1));
      anchors.back().stiffness = ground(kind[kContactByte]);
    }
  }
  return anchors;
}

template <class Real>
std::vector<Anchor> coarse_anchors(const std::vector<Anchor>& fine,
                                   const std::vector<Seat<Real>>& seat) {
  std::vector<Anchor> all;
  all.reserve(fine.size());
  for (const Anchor& anchor : fine) {
    all.push_back(moved(anchor, seat[at(anchor.node)]));
  }
  std::ranges::stable_sort(all, {}, &Anchor::node);
  std::vector<Anchor> coarse;
  const Anchor* end = all.data() + all.size();
  for (const Anchor* first = all.data(); first != end;) {
    const Anchor* last = std::find_if_not(
        first, end, [&](const Anchor& anchor) { return are_alike(anchor, *first); });
    coarse.push_back(united(first, last));
    first = last;
  }
  return coarse;
}

template std::vector<Anchor> coarse_anchors(const std::vector<Anchor>&,
                                            const std::vector<Seat<float>>&);
template std::vector<Anchor> coarse_anchors(const std::vector<Anchor>&,
                                            const std::vector<Seat<double>>&);

}  // namespace holdfast::solver
