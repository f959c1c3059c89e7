// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/cluster_colours.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using host::Team;

constexpr std::uint8_t kNoColour = 255;

class Colours {
 public:
  Colours(const SpringGraph& fine, const Clusters& clusters, Team& team, host::Halo& halo)
      : fine_(fine),
        clusters_(clusters),
        team_(team),
        halo_(halo),
        count_(clusters.member_start.size() - 1) {}

  std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> colours(count_, kNoColour);
    if (fine_.is_part()) {
      colour_on_ranks(colours);
    } else {
      colour_whole(colours);
    }
    return colours;
  }

 private:
  template <class F>
  void for_members(std::size_t cluster, const F& f) const {
    for (std::size_t i = at(clusters_.member_start[cluster]);
         i < at(clusters_.member_start[cluster + 1]); ++i) {
      f(at(clusters_.member[i]));
    }
  }

  template <class F>
  void for_neighbours(std::size_t node, const F& f) const {
    for (std::size_t e = at(fine_.start[node]); e < at(fine_.start[node + 1]); ++e) {
      f(fine_.other[e]);
    }
  }

  /// The rank that each node is of.
  std::vector<std::int32_t> rank_of_nodes() const {
    std::vector<std::int32_t> rank(fine_.order.size(), fine_.ranks.get().rank());
    for (const host::Copy& copy : fine_.copies) {
      rank[at(copy.place)] = copy.original.rank;
    }
    return rank;
  }

  /// The colours of the clusters that nodes have joined, of other ranks' too.
  void tell_colours(const std::vector<std::uint8_t>& colours, std::vector<std::uint8_t>& seen) {
    for (std::size_t node = 0; node < fine_.own_count(); ++node) {
      seen[node] = colours[at(clusters_.of_node[node])];
    }
    halo_.update(seen.data(), sizeof(std::uint8_t));
  }

  /// Where neighbours of two ranks have one colour, the one of the higher rank takes another. Two
  /// of them may then take the same again, and after a few rounds they keep it: they are relaxed at
  /// the same time.
  void part_from_other_ranks(const std::vector<std::int32_t>& rank,
                             std::vector<std::uint8_t>& colours) {
    constexpr int kRoundMax = 8;
    std::vector<std::uint8_t> seen(fine_.order.size());
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kRoundMax; ++round) {
      is_any_changed = false;
      tell_colours(colours, seen);
      for (std::size_t c = 0; c < count_; ++c) {
        std::uint64_t taken = 0;
        bool is_shared = false;
        for_members(c, [&](std::size_t node) {
          for_neighbours(node, [&](std::int32_t other) {
            const bool is_other_cluster =
                fine_.is_copy(other) || at(clusters_.of_node[at(other)]) != c;
            const std::uint8_t used =
                fine_.is_copy(other) ? seen[at(other)] : colours[at(clusters_.of_node[at(other)])];
            taken |= is_other_cluster ? std::uint64_t{1} << used : 0;
            is_shared =
                is_shared || (used == colours[c] && rank[at(other)] < fine_.ranks.get().rank());
          });
        });
        if (is_shared) {
          colours[c] = static_cast<std::uint8_t>(std::min(std::countr_one(taken), 63));
          is_any_changed = true;
        }
      }
      is_any_changed = host::any(fine_.ranks, is_any_changed);
    }
  }

  /// The colour of a cluster's cell on a chessboard.
  std::uint8_t parity(std::size_t cluster) const {
    const std::uint64_t cell =
        fine_.key[at(clusters_.member[at(clusters_.member_start[cluster])])] >> clusters_.shift;
    return static_cast<std::uint8_t>((cell ^ cell >> 1U ^ cell >> 2U) & 1U);
  }

  /// First fit along the curve: two colours on a lattice. `seen` has the colours of the clusters
  /// that copies have joined, where they are known.
  void colour_own(const std::vector<std::uint8_t>& seen, std::vector<std::uint8_t>& colours) const {
    std::ranges::fill(colours, kNoColour);
    for (std::size_t c = 0; c < count_; ++c) {
      std::uint64_t taken = 0;
      for_members(c, [&](std::size_t node) {
        for_neighbours(node, [&](std::int32_t other) {
          const std::uint8_t used =
              fine_.is_copy(other) ? seen[at(other)] : colours[at(clusters_.of_node[at(other)])];
          taken |= used == kNoColour ? 0 : std::uint64_t{1} << used;
        });
      });
      // A 64th colour may be shared by neighbours: the sweep is then not quite Gauss-Seidel.
      colours[c] = static_cast<std::uint8_t>(std::min(std::countr_one(taken), 63));
    }
  }

  /// What first fit comes to on a cubic lattice: a chessboard, on which the first cluster along the
  /// curve, of the first rank that has any, has the first colour.
  void guess_colours(std::vector<std::uint8_t>& colours) const {
    const std::uint8_t mine = count_ > 0 ? parity(0) : kNoColour;
    const auto firsts = host::gather(fine_.ranks, std::span<const std::uint8_t>(&mine, 1));
    const auto first = std::ranges::find_if(firsts, [](auto one) { return one != kNoColour; });
    paint_chessboard(first == firsts.end() ? std::uint8_t{0} : *first, colours);
  }

  /// A chessboard on which clusters of the parity `first` have the first colour.
  void paint_chessboard(std::uint8_t first, std::vector<std::uint8_t>& colours) const {
    team_.share(0, count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        colours[c] = static_cast<std::uint8_t>(parity(c) ^ first);
      }
    });
  }

  /// The colours of one machine: those of lower ranks, whose clusters come before along the curve,
  /// are guessed, then asked for until they stay. As many rounds as ranks would do; after a few
  /// neighbours of two ranks need only have two colours.
  void colour_on_ranks(std::vector<std::uint8_t>& colours) {
    constexpr int kRoundMax = 8;
    const std::vector<std::int32_t> rank = rank_of_nodes();
    std::vector<std::uint8_t> seen(fine_.order.size());
    std::vector<std::uint8_t> before;
    guess_colours(colours);
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kRoundMax; ++round) {
      tell_colours(colours, seen);
      std::vector<std::uint8_t> lower;
      for (const host::Copy& copy : fine_.copies) {
        std::uint8_t& colour = seen[at(copy.place)];
        colour = copy.original.rank < fine_.ranks.get().rank() ? colour : kNoColour;
        lower.push_back(colour);
      }
      const bool is_changed = round == 0 || lower != before;
      if (is_changed) {
        colour_own(seen, colours);
      }
      before = std::move(lower);
      is_any_changed = host::any(fine_.ranks, is_changed);
    }
    if (is_any_changed) {
      part_from_other_ranks(rank, colours);
    }
  }

  /// Whether first fit along the curve leaves all clusters of a whole robot their colours.
  bool are_first_fit(const std::vector<std::uint8_t>& colours) const {
    std::atomic<bool> is_so = true;
    team_.share(0, count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end && is_so.load(std::memory_order_relaxed); ++c) {
        std::uint64_t taken = 0;
        for_members(c, [&](std::size_t node) {
          for_neighbours(node, [&](std::int32_t other) {
            const std::size_t there = at(clusters_.of_node[at(other)]);
            taken |= there < c ? std::uint64_t{1} << colours[there] : 0;
          });
        });
        if (std::countr_one(taken) != colours[c]) {
          is_so = false;
        }
      }
    });
    return is_so;
  }

  /// First fit along the curve. On cubes that is mostly a chessboard, and whether it is threads can
  /// tell; else clusters are coloured one by one.
  void colour_whole(std::vector<std::uint8_t>& colours) const {
    if (fine_.is_along_axes && count_ > 0) {
      paint_chessboard(parity(0), colours);
    }
    if (!fine_.is_along_axes || !are_first_fit(colours)) {
      colour_own({}, colours);
    }
  }

  const SpringGraph& fine_;
  const Clusters& clusters_;
  Team& team_;
  host::Halo& halo_;
  std::size_t count_;
};

}  // namespace

std::vector<std::uint8_t> colour_clusters(const SpringGraph& graph, const Clusters& clusters,
                                          Team& team, host::Halo& halo) {
  return Colours(graph, clusters, team, halo).find();
}

}  // namespace holdfast::solver
