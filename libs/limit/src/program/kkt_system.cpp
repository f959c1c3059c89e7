// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "program/kkt_system.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace holdfast::limit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using JointPart = ConeProgram::JointPart;

/// The stiffness that every motion is given, in units of the program.
constexpr double kLeastStiffness = 1e-12;
/// Scales the row of the factor's bound to about the length of the others.
constexpr double kBoundScale = 1 / kFactorMax;

/// Pairs of groups that joints couple, and which of them each joint is in.
std::vector<solver::Edge> edges_of(const ConeProgram& program,
                                   std::vector<std::size_t>& edge_of_joint) {
  std::map<std::pair<int, int>, std::size_t> found;
  std::vector<solver::Edge> edges;
  for (const JointPart& joint : program.joints) {
    if (joint.a == Part::kNone || joint.b == Part::kNone) {
      edge_of_joint.push_back(0);
      continue;
    }
    const auto [at, is_new] = found.try_emplace(std::minmax(joint.a, joint.b), edges.size());
    if (is_new) {
      edges.push_back({at->first.first, at->first.second});
    }
    edge_of_joint.push_back(at->second);
  }
  return edges;
}

solver::BlockLu stiffness_of(const ConeProgram& program, std::span<const solver::Edge> edges) {
  return {static_cast<std::size_t>(program.loads.size() / 6), edges,
          std::numeric_limits<std::size_t>::max(), solver::Symmetry::kPositive};
}

/// A matrix as the factorization takes it.
base::Mat6<double> packed(const Block& block) {
  base::Mat6<double> result;
  Eigen::Map<Block>(result.values.data()) = block;
  return result;
}

}  // namespace

KktSystem::KktSystem(const ConeProgram& program, double softness, int thread_count)
    : program_(program),
      softness_(softness),
      cones_(program.cones),
      h_(program.h.size() + 1),
      edges_(edges_of(program, edge_of_joint_)),
      stiffness_(stiffness_of(program, edges_)),
      thread_count_(thread_count) {
  h_ << program.h, program.factor_max * kBoundScale;
  cones_.push_back({.row = program.h.size(), .size = 1});
  centre_.resize(h_.size());
  for (const auto& [row, size] : cones_) {
    centre_.segment(row, size) = cone_centre(size);
  }
  scalings_.resize(cones_.size());
  roots_.resize(program.joints.size());
}

VectorXd KktSystem::balance(const VectorXd& x) const {
  VectorXd sum = x[x.size() - 1] * program_.loads;
  for (Index j = 0; j < joint_count(); ++j) {
    const JointPart& joint = program_.joints[static_cast<std::size_t>(j)];
    const auto force = x.segment<6>(6 * j);
    if (joint.a != Part::kNone) {
      sum.segment<6>(6 * joint.a) += joint.on_a * force;
    }
    if (joint.b != Part::kNone) {
      sum.segment<6>(6 * joint.b) += joint.on_b * force;
    }
  }
  return sum;
}

VectorXd KktSystem::rows_times(const VectorXd& x) const {
  VectorXd result(h_.size());
  result[h_.size() - 1] = kBoundScale * x[x.size() - 1];
  for (Index j = 0; j < joint_count(); ++j) {
    const JointPart& joint = program_.joints[static_cast<std::size_t>(j)];
    result.segment(joint.row, joint.rows.rows()) = joint.rows * x.segment<6>(6 * j);
  }
  return result;
}

VectorXd KktSystem::transposed_times(const VectorXd& y, const VectorXd& z) const {
  VectorXd result(force_count());
  result[result.size() - 1] = program_.loads.dot(y) + kBoundScale * z[z.size() - 1];
  for (Index j = 0; j < joint_count(); ++j) {
    const JointPart& joint = program_.joints[static_cast<std::size_t>(j)];
    auto one = result.segment<6>(6 * j);
    one = joint.rows.transpose() * z.segment(joint.row, joint.rows.rows());
    if (joint.a != Part::kNone) {
      one += joint.on_a.transpose() * y.segment<6>(6 * joint.a);
    }
    if (joint.b != Part::kNone) {
      one += joint.on_b.transpose() * y.segment<6>(6 * joint.b);
    }
  }
  return result;
}

bool KktSystem::factor(const VectorXd& s, const VectorXd& z) {
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto& [row, size] = cones_[i];
    const ConePart primal = s.segment(row, size);
    const ConePart dual = z.segment(row, size);
    if (!(inside(primal) > 0 && inside(dual) > 0)) {
      return false;
    }
    scalings_[i] = Scaling(primal, dual);
  }
  lambda_ = scaled(z);
  make_compliances();
  if (!factor_stiffness()) {
    return false;
  }
  loads_solved_ = program_.loads;
  solve_stiffness(loads_solved_);
  const double eta = scalings_.back().times(ConePart::Ones(1))[0];
  border_ = kBoundScale * kBoundScale / (eta * eta) + program_.loads.dot(loads_solved_);
  return true;
}

/// The stiffness by group, of joints as compliant as make_compliances() says.
bool KktSystem::factor_stiffness() {
  std::vector<Block> diagonal(stiffness_.node_count(), Block::Zero());
  std::vector<Block> coupling(edges_.size(), Block::Zero());
  for (std::size_t j = 0; j < program_.joints.size(); ++j) {
    const JointPart& joint = program_.joints[j];
    const Block on_a = roots_[j] * joint.on_a.transpose();
    const Block on_b = roots_[j] * joint.on_b.transpose();
    if (joint.a != Part::kNone) {
      diagonal[static_cast<std::size_t>(joint.a)].noalias() += on_a.transpose() * on_a;
    }
    if (joint.b != Part::kNone) {
      diagonal[static_cast<std::size_t>(joint.b)].noalias() += on_b.transpose() * on_b;
    }
    if (joint.a != Part::kNone && joint.b != Part::kNone) {
      Block& block = coupling[edge_of_joint_[j]];
      if (joint.a < joint.b) {
        block.noalias() += on_a.transpose() * on_b;
      } else {
        block.noalias() += on_b.transpose() * on_a;
      }
    }
  }
  for (Block& block : diagonal) {
    block.diagonal().array() += kLeastStiffness;
  }
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    stiffness_.set_diagonal(i, packed(diagonal[i]));
  }
  for (std::size_t i = 0; i < coupling.size(); ++i) {
    stiffness_.set_edge(i, packed(coupling[i]));
  }
  return stiffness_.factor(thread_count_);
}

void KktSystem::solve_stiffness(VectorXd& x) {
  std::vector<base::Vec6<double>> by_group(stiffness_.node_count());
  for (std::size_t i = 0; i < by_group.size(); ++i) {
    std::copy_n(x.data() + 6 * i, 6, by_group[i].begin());
  }
  stiffness_.solve(by_group);
  for (std::size_t i = 0; i < by_group.size(); ++i) {
    std::copy_n(by_group[i].begin(), 6, x.data() + 6 * i);
  }
}

/// Finds every joint's R with R'R the inverse of G' W^-2 G, by the rotations of a matrix whose rows
/// are of very different lengths, the longest first. Directions without limit are given a stiffness
/// that later steps of the refinement take back.
void KktSystem::make_compliances() {
  using Stack = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 21, 6>;
  for (std::size_t j = 0; j < program_.joints.size(); ++j) {
    const JointPart& joint = program_.joints[j];
    const Index count = joint.rows.rows();
    Stack stack(count + 6, 6);
    for (std::size_t i = joint.cones_begin; i < joint.cones_end; ++i) {
      const auto& [row, size] = cones_[i];
      const ConeRows rows = joint.rows.middleRows(row - joint.row, size);
      stack.middleRows(row - joint.row, size) = scalings_[i].root_times(rows);
    }
    stack.bottomRows<6>() = std::sqrt(softness_) * Block::Identity();
    Eigen::Array<int, Eigen::Dynamic, 1, 0, 21, 1> order(count + 6);
    Eigen::Array<double, Eigen::Dynamic, 1, 0, 21, 1> length = stack.rowwise().squaredNorm();
    for (int i = 0; i < static_cast<int>(count) + 6; ++i) {
      order[i] = i;
    }
    std::sort(order.data(), order.data() + order.size(),
              [&](int a, int b) { return length[a] > length[b]; });
    const Stack sorted = stack(order, Eigen::all);
    const Eigen::ColPivHouseholderQR<Stack> qr(sorted);
    const Block permuted = qr.colsPermutation().transpose() * Block::Identity();
    roots_[j] =
        qr.matrixQR().topRows<6>().triangularView<Eigen::Upper>().transpose().solve(permuted);
  }
}

/// Adds to forces and velocities what solves  H x + A'y = rest.x,  A x = rest.y  with H = G' W^-2
/// G, but for the stiffness of what has no limit, and rounding.
void KktSystem::improve(KktVector& solution, const KktVector& rest) {
  VectorXd force = rest.x;
  VectorXd g = -rest.y;
  for (Index j = 0; j < joint_count(); ++j) {
    const JointPart& joint = program_.joints[static_cast<std::size_t>(j)];
    const Block& root = roots_[static_cast<std::size_t>(j)];
    const Eigen::Matrix<double, 6, 1> moved = root.transpose() * (root * force.segment<6>(6 * j));
    if (joint.a != Part::kNone) {
      g.segment<6>(6 * joint.a) += joint.on_a * moved;
    }
    if (joint.b != Part::kNone) {
      g.segment<6>(6 * joint.b) += joint.on_b * moved;
    }
  }
  solve_stiffness(g);
  const double factor = (force[force.size() - 1] - program_.loads.dot(g)) / border_;
  g += factor * loads_solved_;
  for (Index j = 0; j < joint_count(); ++j) {
    const JointPart& joint = program_.joints[static_cast<std::size_t>(j)];
    const Block& root = roots_[static_cast<std::size_t>(j)];
    auto one = force.segment<6>(6 * j);
    if (joint.a != Part::kNone) {
      one -= joint.on_a.transpose() * g.segment<6>(6 * joint.a);
    }
    if (joint.b != Part::kNone) {
      one -= joint.on_b.transpose() * g.segment<6>(6 * joint.b);
    }
    one = root.transpose() * (root * one).eval();
  }
  force[force.size() - 1] = factor;
  solution.x += force;
  solution.y += g;
}

/// Iterative refinement; the prices follow from the forces.
KktVector KktSystem::solve(const KktVector& right_side) {
  const auto with_prices = [&](KktVector v) {
    v.z = inverse_scaled(inverse_scaled(rows_times(v.x) - right_side.z));
    return v;
  };
  const auto left_by = [&](const KktVector& v) {
    return KktVector{
        .x = right_side.x - transposed_times(v.y, v.z), .y = right_side.y - balance(v.x), .z = {}};
  };
  const auto size_of = [](const KktVector& v) {
    return std::max(v.x.lpNorm<Eigen::Infinity>(), v.y.lpNorm<Eigen::Infinity>());
  };
  KktVector result = with_prices({.x = VectorXd::Zero(right_side.x.size()),
                                  .y = VectorXd::Zero(right_side.y.size()),
                                  .z = {}});
  KktVector rest = left_by(result);
  constexpr int kStepMax = 8;
  constexpr double kEnough = 1e-12;
  const double enough = std::max(kEnough * size_of(rest), std::numeric_limits<double>::min());
  for (int i = 0; i < kStepMax && size_of(rest) > enough; ++i) {
    const double size = size_of(rest);
    KktVector better = result;
    improve(better, rest);
    better = with_prices(std::move(better));
    KktVector left = left_by(better);
    if (!(size_of(left) < size)) {
      break;
    }
    result = std::move(better);
    rest = std::move(left);
    constexpr double kLittle = 0.1;  // What more there is to gain is rounding.
    if (size_of(rest) > kLittle * size) {
      break;
    }
  }
  return result;
}

double factor_work(const ConeProgram& program) {
  std::vector<std::size_t> edge_of_joint;
  const std::vector<solver::Edge> edges = edges_of(program, edge_of_joint);
  return static_cast<double>(stiffness_of(program, edges).factor_product_count());
}

VectorXd KktSystem::scaled(const VectorXd& u) const {
  VectorXd result(u.size());
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto& [row, size] = cones_[i];
    result.segment(row, size) = scalings_[i].times(u.segment(row, size));
  }
  return result;
}

VectorXd KktSystem::inverse_scaled(const VectorXd& u) const {
  VectorXd result(u.size());
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto& [row, size] = cones_[i];
    result.segment(row, size) = scalings_[i].inverse_times(u.segment(row, size));
  }
  return result;
}

VectorXd KktSystem::product(const VectorXd& u, const VectorXd& v) const {
  VectorXd result(u.size());
  for (const auto& [row, size] : cones_) {
    result.segment(row, size) = jordan_product(u.segment(row, size), v.segment(row, size));
  }
  return result;
}

VectorXd KktSystem::quotient(const VectorXd& v) const {
  VectorXd result(v.size());
  for (const auto& [row, size] : cones_) {
    result.segment(row, size) = jordan_quotient(v.segment(row, size), lambda_.segment(row, size));
  }
  return result;
}

double KktSystem::step(const VectorXd& u, const VectorXd& d, double most) const {
  for (const auto& [row, size] : cones_) {
    most = longest_step(u.segment(row, size), d.segment(row, size), most);
  }
  return most;
}

VectorXd KktSystem::outside(const VectorXd& u) const {
  VectorXd result(static_cast<Index>(cones_.size()));
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    result[static_cast<Index>(i)] =
        std::max(0.0, -inside(u.segment(cones_[i].row, cones_[i].size)));
  }
  return result;
}

VectorXd KktSystem::heads(const VectorXd& u) const {
  VectorXd result(static_cast<Index>(cones_.size()));
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    result[static_cast<Index>(i)] = u[cones_[i].row];
  }
  return result;
}

}  // namespace holdfast::limit
