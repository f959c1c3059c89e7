// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Plan, without any file: in which order can an arm on a post be built, is every stage of these
// steps safe, and by which moves does the arm come down to the ground?
//
// $ build/release/examples/plan_a_robot
// > order: found, 5 steps
// > steps: safe, the largest load ratio is 0.1601
// > moves: found, 3 steps, and no plan has fewer

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "holdfast/move.hpp"
#include "holdfast/order.hpp"
#include "holdfast/steps.hpp"

namespace {

namespace hf = holdfast;

hf::io::Document document_of(const std::vector<hf::base::Cell>& cells) {
  hf::io::Document document;
  for (const hf::base::Cell& cell : cells) {
    document.modules.emplace_back().cell = cell;
  }
  return document;
}

int fail(const hf::base::Error& error, const std::string& what) {
  std::cerr << hf::describe(error, what) << '\n';
  return 1;
}

}  // namespace

int main() {
  const hf::io::Document arm =
      document_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}});
  const hf::io::Document wall =
      document_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 1}, {2, 0, 0}});

  const auto order = hf::seek_order(arm, {});
  if (!order) {
    return fail(order.error(), "order");
  }
  const hf::plan::Order& found = order.value().result.order;
  std::printf("order: %s, %zu steps\n", hf::io::name(found.outcome), found.steps.size());

  const auto steps = hf::io::order_steps(order.value().target, found, false);
  if (!steps) {
    return fail(steps.error(), "steps");
  }
  const auto judged = hf::judge_steps({.name = "arm", .document = steps.value(), .warnings = {}});
  if (!judged) {
    return fail(judged.error(), "steps");
  }
  std::printf("steps: %s, the largest load ratio is %.4f\n",
              hf::verdict::name(judged.value().judgement.verdict()),
              judged.value().judgement.load_ratio_max.value_or(0));

  const auto moves = hf::seek_moves(arm, wall);
  if (!moves) {
    return fail(moves.error(), "moves");
  }
  const hf::plan::MovePlan& plan = moves.value().plan;
  std::printf("moves: %s, %zu steps%s\n", hf::plan::name(plan.outcome), plan.steps.size(),
              plan.is_shortest ? ", and no plan has fewer" : "");
}
