// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cycle.hpp"

namespace holdfast::solver {

void Cycle::relax_colour(std::size_t depth, std::size_t colour, bool is_first) {
  Level& level = hierarchy_.levels()[depth];
  const Kernels& kernel = kernels();
  team_.share(level.colour_start[colour], level.colour_start[colour + 1],
              [&](std::size_t begin, std::size_t end) {
                const Range range{begin, end};
                if (is_first) {
                  kernel.relax_first(level.type.data(), level.inverse.data(), level.r.data(),
                                     level.z.data(), range);
                } else if (depth == 0) {
                  kernel.relax_lattice(hierarchy_.lattice(), level.r.data(), level.z.data(), range);
                } else {
                  kernel.relax_cluster(level.view(), level.r.data(), level.z.data(), range);
                }
              });
}

void Cycle::solve_coarsest() {
  Level& level = hierarchy_.levels().back();
  coarsest_.resize(level.node_count);
  for (std::size_t node = 0; node < level.node_count; ++node) {
    for (std::size_t i = 0; i < 6; ++i) {
      coarsest_[node][i] = static_cast<double>(level.r[node].v[i]);
    }
  }
  hierarchy_.coarsest().solve(coarsest_);
  for (std::size_t node = 0; node < level.node_count; ++node) {
    for (std::size_t i = 0; i < 6; ++i) {
      level.z[node].v[i] = static_cast<float>(coarsest_[node][i]);
    }
  }
}

void Cycle::descend(std::size_t depth) {
  if (depth + 1 == hierarchy_.levels().size() && depth > 0) {
    solve_coarsest();
    return;
  }
  Level& level = hierarchy_.levels()[depth];
  const Kernels& kernel = kernels();
  const std::size_t colour_count = level.colour_start.size() - 1;
  // From zero: a colour sees only those before it, so the rest must be zero in the first sweep.
  for (std::size_t p = level.colour_start[1]; p < level.node_count; ++p) {
    level.z[p] = {};
  }
  for (int sweep = 0; sweep < sweep_count_; ++sweep) {
    for (std::size_t colour = 0; colour < colour_count; ++colour) {
      relax_colour(depth, colour, sweep == 0 && colour == 0);
    }
  }
  if (depth + 1 < hierarchy_.levels().size()) {
    Level& coarse = hierarchy_.levels()[depth + 1];
    const std::size_t settled = level.colour_start[colour_count - 1];
    team_.share(0, coarse.node_count, [&](std::size_t begin, std::size_t end) {
      const Range range{begin, end};
      if (depth == 0) {
        kernel.restrict_lattice(hierarchy_.lattice(), level.transfer(), settled, level.r.data(),
                                level.z.data(), coarse.r.data(), range);
      } else {
        kernel.restrict_cluster(level.view(), level.transfer(), settled, level.r.data(),
                                level.z.data(), coarse.r.data(), range);
      }
    });
    descend(depth + 1);
    // The last colour is relaxed next from the others alone: its correction would be overwritten.
    team_.share(0, settled, [&](std::size_t begin, std::size_t end) {
      kernel.prolong(level.transfer(), coarse.z.data(), level.z.data(), {begin, end});
    });
  }
  for (int sweep = 0; sweep < sweep_count_; ++sweep) {
    for (std::size_t colour = colour_count; colour-- > 0;) {
      relax_colour(depth, colour, false);
    }
  }
}

}  // namespace holdfast::solver
