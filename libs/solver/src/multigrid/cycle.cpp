// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cycle.hpp"

#include <algorithm>

namespace holdfast::solver {
namespace {

/// One step of the inner iteration is enough if it removes this share of the residual; Notay's.
constexpr double kEnough = 0.25;

/// The cycle's own length is right within a factor of two or so. A step far from 1 is rounding: on
/// a slender robot the energy of a smooth motion drowns in single precision, and no step is better.
bool is_credible(double step) { return step > 0.25 && step < 4; }

}  // namespace

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

/// The forces that are left at the members become those of the clusters.
void Cycle::pass_down(std::size_t depth, std::size_t settled) {
  Level& level = hierarchy_.levels()[depth];
  Level& coarse = hierarchy_.levels()[depth + 1];
  const Kernels& kernel = kernels();
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
}

/// z = M^-1 r on this level and all below.
void Cycle::descend(std::size_t depth) {
  Level& level = hierarchy_.levels()[depth];
  const std::size_t colour_count = level.colour_start.size() - 1;
  // From zero: a colour sees only those before it, so the rest must be zero in the first sweep.
  team_.share(level.colour_start[1], level.node_count, [&](std::size_t begin, std::size_t end) {
    std::fill(level.z.begin() + static_cast<std::ptrdiff_t>(begin),
              level.z.begin() + static_cast<std::ptrdiff_t>(end), Six{});
  });
  for (int sweep = 0; sweep < sweep_count_; ++sweep) {
    for (std::size_t colour = 0; colour < colour_count; ++colour) {
      relax_colour(depth, colour, sweep == 0 && colour == 0);
    }
  }
  if (depth + 1 < hierarchy_.levels().size()) {
    // The last colour has no forces left, and its correction would be overwritten by the next
    // sweep.
    const std::size_t settled = level.colour_start[colour_count - 1];
    pass_down(depth, settled);
    solve(depth + 1);
    const Level& coarse = hierarchy_.levels()[depth + 1];
    team_.share(0, settled, [&](std::size_t begin, std::size_t end) {
      kernels().prolong(level.transfer(), coarse.z.data(), level.z.data(), {begin, end});
    });
  }
  for (int sweep = 0; sweep < sweep_count_; ++sweep) {
    for (std::size_t colour = colour_count; colour-- > 0;) {
      relax_colour(depth, colour, false);
    }
  }
}

/// K z = r on a coarse level, about: Algorithm 3.2 of [Notay 2008].
void Cycle::solve(std::size_t depth) {
  if (depth + 1 == hierarchy_.levels().size() && hierarchy_.has_coarsest()) {
    solve_coarsest();
    return;
  }
  Level& level = hierarchy_.levels()[depth];
  const std::size_t count = level.node_count;
  descend(depth);
  const double before = dot(count, level.r, level.r);
  const double alpha_1 = dot(count, level.z, level.r);
  const double rho_1 = apply(level, level.first_image);
  const double step = alpha_1 / rho_1;
  if (!is_credible(step)) {
    return;
  }
  combine(count, -step, level.first_image, 1, level.r);
  if (dot(count, level.r, level.r) <= kEnough * kEnough * before) {
    combine(count, step, level.z, 0, level.z);
    return;
  }
  std::swap(level.first, level.z);
  descend(depth);
  const double gamma = dot(count, level.z, level.first_image);
  const double alpha_2 = dot(count, level.z, level.r);
  // Its image is needed for one number only; first_image is not needed any more.
  const double beta = apply(level, level.first_image);
  const double rho_2 = beta - gamma * gamma / rho_1;
  if (!is_credible(alpha_2 / rho_2)) {
    combine(count, step, level.first, 0, level.z);
    return;
  }
  combine(count, step - gamma * alpha_2 / (rho_1 * rho_2), level.first, alpha_2 / rho_2, level.z);
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

/// image = K z; returns z . image.
double Cycle::apply(Level& level, std::vector<Six>& image) {
  return team_.sum(level.node_count, [&](std::size_t begin, std::size_t end) {
    return kernels().apply_cluster(level.view(), level.z.data(), image.data(), {begin, end});
  });
}

double Cycle::dot(std::size_t count, const std::vector<Six>& a, const std::vector<Six>& b) {
  return team_.sum(count, [&](std::size_t begin, std::size_t end) {
    return kernels().dot_single(a.data(), b.data(), {begin, end});
  });
}

/// y = factor x + other y
void Cycle::combine(std::size_t count, double factor, const std::vector<Six>& x, double other,
                    std::vector<Six>& y) {
  team_.share(0, count, [&](std::size_t begin, std::size_t end) {
    kernels().combine(static_cast<float>(factor), x.data(), static_cast<float>(other), y.data(),
                      {begin, end});
  });
}

}  // namespace holdfast::solver
