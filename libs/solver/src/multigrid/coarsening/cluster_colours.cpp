// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/cluster_colours.hpp"

#include "holdfast/base/algebra.hpp"
#include "multigrid/coarsening/first_fit.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// Clusters for FirstFit. Copies of nodes have places after all clusters.
class ClusterItems {
 public:
  ClusterItems(const SpringGraph& fine, const Clusters& clusters, host::Halo& halo)
      : fine_(fine),
        clusters_(clusters),
        halo_(halo),
        count_(clusters.member_start.size() - 1),
        own_count_(fine.own_count()) {}

  std::size_t count() const { return count_; }

  std::size_t place_count() const { return count_ + fine_.order.size() - own_count_; }

  std::size_t place(std::size_t cluster) const { return cluster; }

  template <class F>
  void for_neighbours(std::size_t cluster, const F& f) const {
    for (std::size_t i = at(clusters_.member_start[cluster]);
         i < at(clusters_.member_start[cluster + 1]); ++i) {
      const std::size_t node = at(clusters_.member[i]);
      for (std::size_t e = at(fine_.start[node]); e < at(fine_.start[node + 1]); ++e) {
        f(place_of_node(fine_.other[e]));
      }
    }
  }

  template <class F>
  void for_copies(const F& f) const {
    for (const host::Copy& copy : fine_.copies) {
      f(place_of_node(copy.place), copy.original.rank);
    }
  }

  void tell(std::vector<std::uint8_t>& colours) const {
    std::vector<std::uint8_t> seen(fine_.order.size());
    for (std::size_t node = 0; node < own_count_; ++node) {
      seen[node] = colours[at(clusters_.of_node[node])];
    }
    halo_.update(seen.data(), sizeof(std::uint8_t));
    std::copy(seen.begin() + static_cast<std::ptrdiff_t>(own_count_), seen.end(),
              colours.begin() + static_cast<std::ptrdiff_t>(count_));
  }

  bool is_along_axes() const { return fine_.is_along_axes; }

  std::uint8_t chessboard(std::size_t cluster) const {
    const std::uint64_t cell =
        fine_.key[at(clusters_.member[at(clusters_.member_start[cluster])])] >> clusters_.shift;
    return static_cast<std::uint8_t>((cell ^ cell >> 1U ^ cell >> 2U) & 1U);
  }

  bool has_two_colours() const { return true; }

  std::uint8_t preferred(std::size_t) const { return kNoColour; }

  bool is_before(std::size_t place, std::size_t cluster) const { return place < cluster; }

 private:
  std::size_t place_of_node(std::int32_t node) const {
    return fine_.is_copy(node) ? count_ + at(node) - own_count_ : at(clusters_.of_node[at(node)]);
  }

  const SpringGraph& fine_;
  const Clusters& clusters_;
  host::Halo& halo_;
  std::size_t count_;
  std::size_t own_count_;
};

}  // namespace

std::vector<std::uint8_t> colour_clusters(const SpringGraph& graph, const Clusters& clusters,
                                          host::Team& team, host::Halo& halo) {
  std::vector<std::uint8_t> colours =
      FirstFit(ClusterItems(graph, clusters, halo), graph.ranks, team).find();
  colours.resize(clusters.member_start.size() - 1);
  return colours;
}

}  // namespace holdfast::solver
