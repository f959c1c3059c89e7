// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/gathered_graph.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// What a rank says of one of its nodes.
struct NodeRecord {
  std::uint64_t key = 0;
  Point place = {};
  CellBox box = {};
  std::uint32_t pattern = 0;  ///< Among this rank's springs.
  std::int32_t degree = 0;
  std::int32_t position = 0;  ///< Along the curve, among this rank's nodes.
  bool is_alone = false;
};

/// All ranks' nodes, numbered in the order of the ranks.
struct AllNodes {
  std::vector<std::size_t> first;  ///< Of each rank.
  std::vector<NodeRecord> records;
  std::vector<std::size_t> row;  ///< Where each node's entries in `other` begin.
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> pattern;  ///< Among all ranks' springs.
  std::vector<PackedSpring> springs;
};

/// The number among all of a node here or of a copy.
std::vector<std::int32_t> numbers_among_all(const SpringGraph& part,
                                            const std::vector<std::size_t>& first) {
  std::vector<std::int32_t> number(part.order.size());
  std::iota(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(part.own_count()),
            static_cast<std::int32_t>(first[at(part.ranks.get().rank())]));
  for (const host::Copy& copy : part.copies) {
    number[at(copy.place)] =
        static_cast<std::int32_t>(first[at(copy.original.rank)]) + copy.original.index;
  }
  return number;
}

std::vector<NodeRecord> records_of(const SpringGraph& part) {
  std::vector<NodeRecord> records(part.own_count());
  for (std::size_t node = 0; node < part.own_count(); ++node) {
    records[node] = {.key = part.key[node],
                     .place = part.place[node],
                     .box = part.box.empty() ? CellBox{} : part.box[node],
                     .pattern = part.pattern[node],
                     .degree = part.start[node + 1] - part.start[node],
                     .is_alone = !part.is_alone.empty() && part.is_alone[node]};
  }
  for (std::size_t i = 0; i < part.own_count(); ++i) {
    records[at(part.order[i])].position = static_cast<std::int32_t>(i);
  }
  return records;
}

AllNodes all_nodes(const SpringGraph& part) {
  host::Ranks& ranks = part.ranks;
  AllNodes all;
  all.first = host::starts(ranks, part.own_count());
  all.records = host::gather<NodeRecord>(ranks, records_of(part));
  const std::vector<std::int32_t> number = numbers_among_all(part, all.first);
  std::vector<std::int32_t> other;
  for (const std::int32_t node : std::span(part.other).first(at(part.start[part.own_count()]))) {
    other.push_back(number[at(node)]);
  }
  all.other = host::gather<std::int32_t>(ranks, other);
  const std::vector<std::size_t> first_spring = host::starts(ranks, part.springs.size());
  all.springs = host::gather<PackedSpring>(ranks, part.springs);
  all.row = {0};
  for (std::size_t rank = 0; rank + 1 < all.first.size(); ++rank) {
    for (std::size_t node = all.first[rank]; node < all.first[rank + 1]; ++node) {
      all.row.push_back(all.row.back() + at(all.records[node].degree));
      all.pattern.push_back(static_cast<std::uint32_t>(first_spring[rank]) +
                            all.records[node].pattern);
    }
  }
  return all;
}

/// Clusters of one cell stay in the order of their first members, as on one machine.
std::vector<std::int32_t> curve_of(const AllNodes& all) {
  std::vector<std::int32_t> curve(all.records.size());
  for (std::size_t rank = 0; rank + 1 < all.first.size(); ++rank) {
    for (std::size_t i = all.first[rank]; i < all.first[rank + 1]; ++i) {
      curve[all.first[rank] + at(all.records[i].position)] = static_cast<std::int32_t>(i);
    }
  }
  std::ranges::stable_sort(curve, {}, [&](std::int32_t node) { return all.records[at(node)].key; });
  return curve;
}

/// Colours the nodes first-fit along the curve; returns what each is called then.
std::vector<std::int32_t> node_by_colour(const AllNodes& all,
                                         const std::vector<std::int32_t>& curve,
                                         std::vector<std::size_t>& colour_start) {
  constexpr std::size_t kColourMax = 64;
  std::vector<std::size_t> colour(curve.size(), kColourMax);
  std::array<std::size_t, kColourMax> count{};
  for (const std::int32_t node : curve) {
    std::uint64_t taken = 0;
    for (std::size_t e = all.row[at(node)]; e < all.row[at(node) + 1]; ++e) {
      const std::size_t used = colour[at(all.other[e])];
      taken |= used == kColourMax ? 0 : std::uint64_t{1} << used;
    }
    colour[at(node)] = std::min(at(std::countr_one(taken)), kColourMax - 1);
    ++count[colour[at(node)]];
  }
  std::array<std::size_t, kColourMax> next{};
  colour_start = {0};
  for (std::size_t k = 0; k < kColourMax; ++k) {
    next[k] = colour_start.back();
    if (count[k] > 0) {
      colour_start.push_back(colour_start.back() + count[k]);
    }
  }
  std::vector<std::int32_t> node_of(curve.size());
  for (const std::int32_t node : curve) {
    node_of[at(node)] = static_cast<std::int32_t>(next[colour[at(node)]]++);
  }
  return node_of;
}

}  // namespace

SpringGraph gathered_graph(const SpringGraph& part, Gathering& gathering,
                           std::vector<std::size_t>& colour_start) {
  AllNodes all = all_nodes(part);
  const std::vector<std::int32_t> curve = curve_of(all);
  std::vector<std::int32_t> node_of = node_by_colour(all, curve, colour_start);
  const std::size_t count = curve.size();
  std::vector<std::int32_t> number(count);  // Among all, by node.
  for (std::size_t i = 0; i < count; ++i) {
    number[at(node_of[i])] = static_cast<std::int32_t>(i);
  }
  SpringGraph graph;
  graph.shift = part.shift;
  graph.is_along_axes = part.is_along_axes;
  graph.springs = std::move(all.springs);
  graph.start = {0};
  const bool is_any_alone =
      std::ranges::any_of(all.records, [](const NodeRecord& record) { return record.is_alone; });
  for (std::size_t node = 0; node < count; ++node) {
    const std::size_t i = at(number[node]);
    const NodeRecord& record = all.records[i];
    graph.order.push_back(node_of[at(curve[node])]);
    graph.key.push_back(record.key);
    graph.place.push_back(record.place);
    if (!part.box.empty()) {
      graph.box.push_back(record.box);
    }
    if (is_any_alone) {
      graph.is_alone.push_back(record.is_alone);
    }
    graph.pattern.push_back(all.pattern[i]);
    for (std::size_t e = all.row[i]; e < all.row[i + 1]; ++e) {
      graph.other.push_back(node_of[at(all.other[e])]);
    }
    graph.start.push_back(static_cast<std::int32_t>(graph.other.size()));
  }
  gathering = {.node = std::move(node_of),
               .first = all.first[at(part.ranks.get().rank())],
               .own_count = part.own_count()};
  return graph;
}

std::vector<GroundSpring> gathered_springs(const std::vector<GroundSpring>& part,
                                           const Gathering& gathering, host::Ranks& ranks) {
  std::vector<GroundSpring> mine = part;
  for (GroundSpring& spring : mine) {
    spring.node = gathering.node[gathering.first + at(spring.node)];
  }
  std::vector<GroundSpring> all = host::gather<GroundSpring>(ranks, mine);
  std::ranges::stable_sort(all, {}, &GroundSpring::node);
  return all;
}

}  // namespace holdfast::solver
