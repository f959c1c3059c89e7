// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/slivers.hpp"

#include <algorithm>
#include <utility>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;

constexpr std::int32_t kNone = -1;

/// The first one met of two neighbours that are tied equally, up to rounding, is taken.
constexpr double kStronger = 1 + 1e-9;

CellBox united(CellBox a, const CellBox& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    a.low[k] = std::min(a.low[k], b.low[k]);
    a.high[k] = std::max(a.high[k], b.high[k]);
  }
  return a;
}

bool fits(const CellBox& box, std::int32_t width) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (box.high[k] - box.low[k] >= width) {
      return false;
    }
  }
  return true;
}

/// Calls f(c, d, strength) for every spring between two clusters, once for each of them.
template <class F>
void for_ties(const SpringGraph& fine, const std::vector<std::int32_t>& cluster, const F& f) {
  for (std::size_t node = 0; node < fine.own_count(); ++node) {
    const std::size_t start = at(fine.start[node]);
    for (std::size_t e = start; e < at(fine.start[node + 1]); ++e) {
      if (fine.is_copy(fine.other[e])) {
        continue;
      }
      const std::int32_t to = cluster[at(fine.other[e])];
      if (to != cluster[node]) {
        f(at(cluster[node]), to, fine.springs[fine.pattern[node] + e - start].strength());
      }
    }
  }
}

using Ties = std::vector<std::pair<std::int32_t, double>>;

/// The neighbours of each cluster that it would fit into one cell with, and how strongly they are
/// tied to it.
std::vector<Ties> ties_that_fit(const SpringGraph& fine, std::int32_t width,
                                const std::vector<std::int32_t>& cluster,
                                const std::vector<CellBox>& box) {
  std::vector<Ties> ties(box.size());
  for_ties(fine, cluster, [&](std::size_t c, std::int32_t d, double strength) {
    const auto found = std::ranges::find(ties[c], d, &Ties::value_type::first);
    if (found != ties[c].end()) {
      found->second += strength;
    } else if (fits(united(box[c], box[at(d)]), width)) {
      ties[c].emplace_back(d, strength);
    }
  });
  return ties;
}

}  // namespace

std::size_t unite_slivers(const SpringGraph& fine, unsigned shift,
                          std::vector<std::int32_t>& cluster, std::size_t count,
                          std::vector<CellBox>& box) {
  const std::vector<CellBox>& part = fine.box;
  std::vector<CellBox> old(count);
  std::vector<bool> is_met(count);
  std::vector<bool> is_alone(count);
  for (std::size_t node = 0; node < fine.own_count(); ++node) {
    const std::size_t c = at(cluster[node]);
    is_alone[c] = !fine.is_alone.empty() && fine.is_alone[node];
    old[c] = is_met[c] ? united(old[c], part[node]) : part[node];
    is_met[c] = true;
  }
  const auto ties = ties_that_fit(fine, std::int32_t{1} << (shift / 3), cluster, old);
  std::vector<std::int32_t> number(count, kNone);
  box.clear();
  for (std::size_t c = 0; c < count; ++c) {
    if (number[c] != kNone) {
      continue;
    }
    std::int32_t partner = kNone;
    double most = 0;
    for (const auto& [d, strength] : ties[c]) {
      if (number[at(d)] == kNone && !is_alone[c] && !is_alone[at(d)] &&
          strength > most * kStronger) {
        most = strength;
        partner = d;
      }
    }
    number[c] = static_cast<std::int32_t>(box.size());
    box.push_back(old[c]);
    if (partner != kNone) {
      number[at(partner)] = number[c];
      box.back() = united(box.back(), old[at(partner)]);
    }
  }
  for (std::size_t node = 0; node < fine.own_count(); ++node) {
    cluster[node] = number[at(cluster[node])];
  }
  return box.size();
}

}  // namespace holdfast::solver
