// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/order_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/csv.hpp"
#include "holdfast/io/order_certificate.hpp"
#include "json/json_text.hpp"
#include "report/kept_text.hpp"

namespace holdfast::io {
namespace {

using plan::OrderOutcome;

std::vector<base::Cell> cells_of(const OrderReport& report,
                                 const std::vector<plan::Element>& elements) {
  std::vector<base::Cell> cells;
  for (const plan::Element element : elements) {
    cells.push_back(report.task.target.existing[static_cast<std::size_t>(element)]);
  }
  return cells;
}

/// A way from one state to the next, or the first state, and what is known of it.
std::string state_text(std::string_view key, const std::vector<base::Cell>& cells,
                       const plan::Judgement& judged) {
  return object({member(key, json_text(cells)),
                 member(judged.is_bound ? "load_ratio_bound" : "load_ratio_max",
                        json_text(judged.load_ratio_max)),
                 member("margin_mm", json_text(judged.margin_mm))});
}

/// Every state on the way, in its order, with what led to it.
Items way_items(const OrderReport& report) {
  const plan::Order& order = report.result.order;
  const std::size_t count = order.steps.size();
  Items items;
  for (std::size_t i = 0; i < order.judgements.size(); ++i) {
    const std::size_t k = report.is_reversed ? count - i : i;
    const std::size_t step = report.is_reversed ? k : k - 1;
    const std::vector<plan::Element> none;
    const auto& group = i == 0 ? none : order.steps[step];
    items.push_back(state_text(report.is_reversed ? "detach" : "attach", cells_of(report, group),
                               order.judgements[k]));
  }
  return items;
}

std::string help_text(const OrderReport& report) {
  if (!report.help) {
    return "null";
  }
  const auto& rule = report.help->rule;
  return object({member("supports", json_text(report.help->supports)),
                 member("temporary", json_text(report.help->temporary)),
                 member("reach", rule ? json_text(std::string(plan::name(rule->reach))) : "null"),
                 member("source", rule && rule->source ? json_text(*rule->source) : "null"),
                 member("pieces", report.help->in_pieces ? "true" : "false")});
}

std::string words(const std::vector<base::Cell>& cells) {
  std::vector<std::string> names;
  std::ranges::transform(cells, std::back_inserter(names), &model::text);
  return fmt::format("{}", fmt::join(names, " "));
}

/// Says with which other ways there is an order, and why not with those of the task.
std::string way_words(const plan::OrderTask& task, const plan::ReachRule& other) {
  if (!other.source) {
    return fmt::format("  suggestion  only the ways bar it: with --reach {} there is an order\n",
                       plan::name(other.reach));
  }
  const base::Cell& source = *task.rule.source;
  const bool is_taken =
      std::ranges::find(task.target.existing, source) != task.target.existing.end();
  return fmt::format(
      "  suggestion  only the ways from {}{} bar it: with --source {},{},{} there is an order\n",
      model::text(source), is_taken ? ", a cell of the target," : "", other.source->x,
      other.source->y, other.source->z);
}

std::string help_words(const OrderReport& report) {
  if (!report.is_help_sought) {
    return "";
  }
  if (!report.help) {
    return "  suggestion  none: no single support and no few temporary modules were found that "
           "would suffice\n";
  }
  const plan::Help& help = *report.help;
  const std::string pieces =
      help.in_pieces ? "  suggestion  in several pieces there is an order: seek it with --pieces\n"
                     : "";
  if (help.rule) {
    return way_words(report.task, *help.rule) + pieces;
  }
  const bool is_support = !help.supports.empty();
  if (!is_support && help.temporary.empty()) {
    return pieces;
  }
  const std::string line =
      is_support
          ? fmt::format("a support in {} makes a safe order possible", words(help.supports))
          : "add these as temporary modules and remove them at the end: " + words(help.temporary);
  return fmt::format("  suggestion  {}\n{}", line, pieces);
}

/// Says how far the search got.
std::string furthest_words(const OrderReport& report) {
  const plan::Order& order = report.result.order;
  if (order.steps.empty()) {
    return "";
  }
  std::size_t count = report.is_reversed ? report.task.target.existing.size() : order.start.size();
  for (const plan::Batch& group : order.steps) {
    count = report.is_reversed ? count - group.size() : count + group.size();
  }
  return fmt::format("  as far as   {} of {}, by {}, every state {} is safe\n", count,
                     host::counted(report.task.target.existing.size(), "module"),
                     host::counted(order.steps.size(), "step"),
                     report.is_reversed ? "left behind" : "on the way");
}

std::string none_words(const OrderReport& report) {
  const plan::Closure& closure = report.result.certificate->closure;
  const bool is_growing = closure.sense == plan::Sense::kGrowing;
  if (closure.states.empty()) {
    return fmt::format("  proof       {} is not safe: {}\n",
                       is_growing ? "no start" : "the target itself",
                       verdict::name(closure.blocked.front().second.verdict));
  }
  const std::string reached = fmt::format("  proof       {} can be reached from {}, and ",
                                          host::counted(closure.states.size(), "safe state"),
                                          is_growing ? "the start" : "the target, backwards,");
  if (closure.blocked.empty()) {
    return reached + "no step leads any further\n";
  }
  return fmt::format("{}{} that one step more leads to {} not safe\n", reached,
                     closure.blocked.size() == 1
                         ? "the only state"
                         : fmt::format("all {} states", closure.blocked.size()),
                     closure.blocked.size() == 1 ? "is" : "are");
}

std::size_t largest_batch(const plan::Order& order) {
  std::size_t largest = 0;
  for (const plan::Batch& group : order.steps) {
    largest = std::max(largest, group.size());
  }
  return largest;
}

/// Says how many steps there are, and what they hold.
std::string found_words(const OrderReport& report) {
  const plan::Order& order = report.result.order;
  const std::string steps = host::counted(order.steps.size(), "step");
  const auto is_of_several = [](const plan::Batch& group) { return group.size() > 1; };
  if (!order.is_any_order) {
    return fmt::format(
        "FOUND       {}, every state {} is safe\n{}", steps,
        report.is_reversed ? "left behind" : "on the way",
        std::ranges::none_of(order.steps, is_of_several)
            ? ""
            : "  at once     modules of one step have to arrive at the same instant: states in "
              "between are not judged\n");
  }
  const std::size_t count = report.task.target.existing.size() - order.start.size();
  return fmt::format(
      "FOUND       {} for {}, safe whichever part of a step has {}\n"
      "  at a time   {} at most; from this start nothing takes fewer than {}\n",
      steps, host::counted(count, "module"), report.is_reversed ? "gone" : "come",
      host::counted(largest_batch(order), "module"),
      host::counted(report.result.step_count_least.value_or(0), "step"));
}

std::string parallel_text(const OrderReport& report) {
  const auto& least = report.result.step_count_least;
  const std::size_t most = report.task.parallel_max;
  const bool is_all = most >= report.task.target.existing.size();
  return most == 1 ? "null"
                   : object({member("modules_max", is_all ? "null" : fmt::format("{}", most)),
                             member("steps_least", least ? fmt::format("{}", *least) : "null")});
}

/// A line, or nothing if no load is known.
std::string load_ratio_words(const plan::RobotOrder& result) {
  if (!result.load_ratio_max) {
    return "";
  }
  const std::string largest = beside_one(*result.load_ratio_max, 4);
  if (std::ranges::none_of(result.order.judgements, &plan::Judgement::is_bound)) {
    return fmt::format("  load ratio  largest {}\n", largest);
  }
  return fmt::format(
      "  load ratio  {} is the largest of the states that were solved, no state exceeds {}\n",
      largest, beside_one(*result.load_ratio_bound, 4));
}

}  // namespace

const char* name(OrderOutcome outcome) {
  switch (outcome) {
    case OrderOutcome::kFound:
      return "found";
    case OrderOutcome::kNone:
      return "none";
    case OrderOutcome::kNotFound:
      break;
  }
  return "not-found";
}

std::string order_json(const OrderReport& report, const std::vector<std::string>& more) {
  const plan::Order& order = report.result.order;
  std::string certificate = "null";
  if (report.result.certificate) {
    certificate = write_order_certificate(report.target, *report.result.certificate);
    certificate.pop_back();
  }
  Items items = report_head({.command = "order",
                             .origin = report.origin,
                             .module_count = report.task.target.existing.size()});
  const Items found = {member("result", json_text(std::string(name(order.outcome)))),
                       member("steps", fmt::format("{}", order.steps.size())),
                       member("states", fmt::format("{}", order.state_count)),
                       member("load_ratio_max", json_text(report.result.load_ratio_max)),
                       member("load_ratio_bound", json_text(report.result.load_ratio_bound)),
                       member("margin_min_mm", json_text(report.result.margin_min_mm)),
                       member("seconds", json_text(report.seconds)),
                       member("start", json_text(cells_of(report, order.start.elements()))),
                       member("way", array(way_items(report), 2)),
                       member("parallel", parallel_text(report)),
                       member("help", help_text(report)),
                       member("certificate", certificate)};
  items.insert(items.end(), found.begin(), found.end());
  if (report.kept_count) {
    items.push_back(member("kept", fmt::format("{}", *report.kept_count)));
  }
  items.insert(items.end(), more.begin(), more.end());
  return lines('{', items, '}', 0) + "\n";
}

std::string order_step_line(const OrderReport& report, std::size_t number, const plan::Batch& step,
                            const plan::Judgement& judged) {
  const std::string_view key = number == 0 ? "start" : report.is_reversed ? "detach" : "attach";
  return state_text(key, cells_of(report, step), judged);
}

std::string order_last_line(const OrderReport& report) {
  const plan::Order& order = report.result.order;
  const bool is_found = order.outcome == OrderOutcome::kFound;
  const bool is_open = order.outcome == OrderOutcome::kNotFound;
  const std::string why = order.undecided_count > 0 ? "undecided"
                          : report.is_interrupted   ? "interrupt"
                                                    : "time";
  return object({member("result", json_text(std::string(name(order.outcome)))),
                 member("steps", fmt::format("{}", is_found ? order.steps.size() : 0)),
                 member("reason", is_open ? json_text(why) : "null"),
                 member("seconds", json_text(report.seconds))});
}

std::string order_csv(const OrderReport& report) {
  CsvTable table("step,x,y,z,verdict,load_ratio_max,load_ratio_bound,margin_mm");
  const plan::Order& order = report.result.order;
  const std::size_t count = order.judgements.empty() ? 0 : order.steps.size();
  for (std::size_t i = 1; i <= count; ++i) {
    const plan::Judgement& judged = order.judgements[report.is_reversed ? count - i : i];
    const std::optional<double> none;
    for (const base::Cell& cell :
         cells_of(report, order.steps[report.is_reversed ? count - i : i - 1])) {
      table.count(i - 1).cell(cell).word(verdict::name(judged.verdict));
      table.number(judged.is_bound ? none : judged.load_ratio_max);
      table.number(judged.is_bound ? judged.load_ratio_max : none);
      table.number(judged.margin_mm).end_row();
    }
  }
  return table.text();
}

std::string order_text(const OrderReport& report) {
  const plan::Order& order = report.result.order;
  const std::string examined = fmt::format(
      "  examined    {} in {:.2f} s\n", host::counted(order.state_count, "state"), report.seconds);
  if (order.outcome == OrderOutcome::kNotFound) {
    const std::string why =
        order.undecided_count == 0
            ? fmt::format("no order found before {}; there may be one\n",
                          report.is_interrupted ? "the search was interrupted" : "the search ended")
            : fmt::format("every order leads through states that are undecided, {} at one end\n",
                          order.undecided_count);
    return "NOT FOUND   " + why + furthest_words(report) + examined;
  }
  if (order.outcome == OrderOutcome::kNone) {
    return std::string("NONE        there is no safe order") +
           (report.task.in_pieces ? ", in one piece or in several\n"
                                  : " that keeps the robot in one piece\n") +
           none_words(report) + help_words(report) + examined;
  }
  std::string text = found_words(report) + kept_words(report.kept_count, order.steps.size());
  text += load_ratio_words(report.result);
  if (report.result.margin_min_mm) {
    text += fmt::format("  margin      smallest {} mm\n",
                        host::significant(*report.result.margin_min_mm, 4));
  }
  return text + examined;
}

std::string order_way_text(const OrderReport& report) {
  constexpr std::size_t kShownMax = 20;
  const plan::Order& order = report.result.order;
  const std::size_t count = order.steps.size();
  const std::size_t shown = std::min(count, kShownMax);
  std::vector<std::string> groups;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t step = report.is_reversed ? count - 1 - i : i;
    groups.push_back(words(cells_of(report, order.steps[step])));
  }
  if (shown < count) {
    groups.push_back(fmt::format("{} more", count - shown));
  }
  return fmt::format(
      "{}{}  written     nowhere: -o STEPS.json writes the order\n",
      report.is_reversed || order.start.size() > 1
          ? ""
          : "  start       " + words(cells_of(report, order.start.elements())) + '\n',
      groups.empty() ? ""
                     : fmt::format("  {:<10}  {}\n", report.is_reversed ? "detach" : "attach",
                                   fmt::join(groups, ", then ")));
}

}  // namespace holdfast::io
