// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/order_certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "json/json_text.hpp"
#include "json/json_values.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

constexpr const char* kFormat = "holdfast-order-certificate";

using plan::ElementSet;

/// Writes a state, in which character i is 1 if module i is there.
std::string state_text(const ElementSet& state, std::size_t module_count) {
  std::string text(module_count, '0');
  for (const plan::Element element : state.elements()) {
    text[static_cast<std::size_t>(element)] = '1';
  }
  return text;
}

std::string blocked_text(const ElementSet& state, const plan::Judgement& judged,
                         std::size_t module_count) {
  const auto number = [](const std::optional<double>& value) {
    return value ? json_text(*value) : std::string("null");
  };
  return object({member("state", json_text(state_text(state, module_count))),
                 member("verdict", json_text(std::string(verdict::name(judged.verdict)))),
                 member("load_ratio_max", number(judged.load_ratio_max)),
                 member("margin_mm", number(judged.margin_mm))});
}

/// Reads the members of a certificate; the first that is not as it should be is the error.
class CertificateReader {
 public:
  explicit CertificateReader(const Json& root) : root_(root) {}

  base::Result<NamedOrderCertificate> read();

 private:
  void fail(const std::string& key, const std::string& expected) {
    if (!error_) {
      error_ = {base::ErrorCode::kBadInput, "expected " + expected, "/" + key};
    }
  }

  const Json& at(const char* key) const {
    static const Json kNone;
    const auto member = root_.find(key);
    return member == root_.end() ? kNone : *member;
  }

  std::string choice(const char* key, const std::vector<std::string>& names);
  base::Cell cell(const std::string& key, const Json& value);
  void read_task();
  void read_states();

  const Json& root_;
  std::string name_;
  plan::OrderCertificate certificate_;
  std::optional<base::Error> error_;
};

std::string CertificateReader::choice(const char* key, const std::vector<std::string>& names) {
  const Json& value = at(key);
  std::string name = value.is_string() ? value.get<std::string>() : "";
  if (std::ranges::find(names, name) == names.end()) {
    fail(key, fmt::format("{}, found {}", fmt::join(names, " or "),
                          value.is_string() ? excerpt(name) : value.type_name()));
  }
  return name;
}

base::Cell CertificateReader::cell(const std::string& key, const Json& value) {
  const auto is_coordinate = [](const Json& number) {
    return number.is_number_integer() && std::abs(number.get<double>()) <= base::kCoordinateMax;
  };
  if (!value.is_array() || value.size() != 3 || !std::ranges::all_of(value, is_coordinate)) {
    fail(key, "a cell [x, y, z]");
    return {};
  }
  return {value[0].get<std::int32_t>(), value[1].get<std::int32_t>(), value[2].get<std::int32_t>()};
}

void CertificateReader::read_task() {
  plan::OrderTask& task = certificate_.task;
  const auto document = read_json(at("target").dump());
  if (!document) {
    error_ = document.error();
    error_->where = "/target" + error_->where;
    return;
  }
  name_ = document.value().document.name;
  auto target = order_target(document.value().document);
  if (!target) {
    error_ = target.error();
    return;
  }
  task.target = std::move(target).value();
  if (!at("start").is_array()) {
    fail("start", "an array of cells");
    return;
  }
  for (const Json& value : at("start")) {
    task.start.push_back(cell("start", value));
  }
  const Json& group = at("group");
  if (!group.is_number_unsigned() || group.get<std::size_t>() == 0) {
    fail("group", "a count, 1 or more");
    return;
  }
  task.group_size = group.get<std::size_t>();
  if (!at("pieces").is_null() && !at("pieces").is_boolean()) {
    fail("pieces", "true or false");
    return;
  }
  task.in_pieces = at("pieces") == true;
  const std::string reach = choice("reach", {"free", "line", "surface"});
  for (const plan::Reach each : {plan::Reach::kLine, plan::Reach::kSurface}) {
    task.rule.reach = reach == plan::name(each) ? each : task.rule.reach;
  }
  if (!at("source").is_null()) {
    task.rule.source = cell("source", at("source"));
  }
  if (!at("avoid").is_null() && !at("avoid").is_array()) {
    fail("avoid", "an array of cells");
    return;
  }
  for (const Json& value : at("avoid")) {
    task.rule.avoid.push_back(cell("avoid", value));
  }
}

void CertificateReader::read_states() {
  const std::string ways = choice("sense", {"attach", "detach"});
  certificate_.closure.sense = ways == "attach" ? plan::Sense::kGrowing : plan::Sense::kShrinking;
  const std::size_t count = certificate_.task.target.existing.size();
  const std::string expected = fmt::format("an array of texts of {} characters 0 or 1", count);
  if (!at("states").is_array()) {
    fail("states", expected);
    return;
  }
  for (const Json& value : at("states")) {
    const std::string text = value.is_string() ? value.get<std::string>() : "";
    if (text.size() != count || text.find_first_not_of("01") != std::string::npos) {
      fail("states", expected);
      return;
    }
    ElementSet& state = certificate_.closure.states.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (text[i] == '1') {
        state.insert(static_cast<plan::Element>(i));
      }
    }
  }
}

base::Result<NamedOrderCertificate> CertificateReader::read() {
  choice("format", {kFormat});
  if (at("version") != 1) {
    fail("version", "1");
  }
  if (!error_) {
    read_task();
  }
  if (!error_) {
    read_states();
  }
  if (error_) {
    return *error_;
  }
  return NamedOrderCertificate{std::move(name_), std::move(certificate_)};
}

/// Makes the modules of all planned steps existing ones, with what they have of their own.
void gather_modules(Document& document) {
  std::vector<std::size_t> first_of_step = {0};
  for (const Step& step : document.steps) {
    first_of_step.push_back(document.modules.size());
    for (const PlannedEntry& planned : step) {
      document.modules.push_back({.cell = planned.cell,
                                  .is_fixed = false,
                                  .color = planned.color,
                                  .attributes = planned.attributes});
    }
  }
  for (OwnParameters& own : document.extension.own) {
    own.module += first_of_step[own.step];
    own.step = 0;
  }
  document.steps.clear();
  document.known_answer.reset();
  document.description.clear();
}

/// Takes modules out, and what they have of their own. The cells are in ascending order.
void leave_out(Document& document, const std::vector<base::Cell>& cells) {
  std::vector<ModuleEntry> kept;
  std::vector<OwnParameters> own;
  auto next = document.extension.own.begin();
  for (std::size_t i = 0; i < document.modules.size(); ++i) {
    const bool has_own = next != document.extension.own.end() && next->module == i;
    const auto mine = has_own ? next++ : next;
    if (std::ranges::binary_search(cells, document.modules[i].cell)) {
      continue;
    }
    if (has_own) {
      own.push_back(*mine);
      own.back().module = kept.size();
    }
    kept.push_back(std::move(document.modules[i]));
  }
  document.modules = std::move(kept);
  document.extension.own = std::move(own);
}

/// Whether one of the modules, in ascending order, has a kind or a mass of its own, which "attach"
/// of a step does not say.
bool is_any_special(const model::RobotSpec& spec, const std::vector<base::Cell>& cells) {
  const auto is_one = [&](const auto& own) { return std::ranges::binary_search(cells, own.cell); };
  return std::ranges::any_of(spec.own_kinds, is_one) ||
         std::ranges::any_of(spec.own_masses, is_one);
}

/// The cells of every step as "planned" and "later_steps", whose modules have kinds and masses;
/// beside them what they have of their own.
std::vector<OwnParameters> plan_modules(const Document& target,
                                        const std::vector<model::Step>& plan,
                                        std::vector<Step>& steps) {
  model::CellIndex index(target.modules.size());
  for (std::size_t i = 0; i < target.modules.size(); ++i) {
    index.insert(target.modules[i].cell, static_cast<std::int32_t>(i));
  }
  std::vector<const OwnParameters*> own_of(target.modules.size());
  for (const OwnParameters& own : target.extension.own) {
    own_of[own.module] = &own;
  }
  std::vector<OwnParameters> all;
  for (const model::Step& step : plan) {
    Step& entries = steps.emplace_back();
    for (const base::Cell& cell : step.attach) {
      const auto place = static_cast<std::size_t>(index.find(cell));
      const ModuleEntry& module = target.modules[place];
      if (own_of[place] != nullptr) {
        all.push_back(*own_of[place]);
        all.back().step = steps.size();
        all.back().module = entries.size();
      }
      entries.push_back({.cell = cell, .color = module.color, .attributes = module.attributes});
    }
  }
  return all;
}

}  // namespace

base::Result<model::RobotSpec> order_target(const Document& document) {
  if (!document.extension.plan.empty() || document.steps.size() > 1) {
    return base::Error{base::ErrorCode::kBadInput,
                       "the target has steps of its own: an order is for modules that exist "
                       "or are planned at once, without \"steps\" and \"later_steps\"",
                       step_list(document)};
  }
  auto spec = make_spec(document);
  if (spec) {
    model::RobotSpec target = std::move(spec).value();
    target.existing.insert(target.existing.end(), target.planned.begin(), target.planned.end());
    target.planned.clear();
    return target;
  }
  return spec;
}

Document with_all_modules(Document document) {
  gather_modules(document);
  for (const model::Step& step : std::exchange(document.extension.plan, {})) {
    for (const base::Cell& cell : step.attach) {
      document.modules.push_back({.cell = cell, .is_fixed = false, .color = {}, .attributes = {}});
    }
  }
  return document;
}

Document without_modules(Document document, std::vector<base::Cell> cells) {
  std::ranges::sort(cells);
  leave_out(document, cells);
  return document;
}

std::string write_order_certificate(const Document& target,
                                    const plan::OrderCertificate& certificate) {
  const plan::OrderTask& task = certificate.task;
  const std::size_t count = task.target.existing.size();
  Items states;
  for (const ElementSet& state : certificate.closure.states) {
    states.push_back(json_text(state_text(state, count)));
  }
  Items blocked;
  for (const auto& [state, judged] : certificate.closure.blocked) {
    blocked.push_back(blocked_text(state, judged, count));
  }
  std::string structure = write_json(with_allowed_strengths(target));
  structure.erase(structure.find_last_not_of('\n') + 1);
  const bool is_growing = certificate.closure.sense == plan::Sense::kGrowing;
  const auto& source = task.rule.source;
  Items items = {member("format", json_text(std::string(kFormat))),
                 member("version", "1"),
                 member("target", structure),
                 member("start", json_text(std::span(task.start))),
                 member("group", fmt::format("{}", task.group_size)),
                 member("reach", json_text(std::string(plan::name(task.rule.reach)))),
                 member("source", source ? json_text(*source) : "null")};
  if (!task.rule.avoid.empty()) {
    items.push_back(member("avoid", json_text(std::span(task.rule.avoid))));
  }
  if (task.in_pieces) {
    items.push_back(member("pieces", "true"));
  }
  items.push_back(member("sense", json_text(std::string(is_growing ? "attach" : "detach"))));
  items.push_back(member("states", array(states, 2)));
  items.push_back(member("blocked", array(blocked, 2)));
  return lines('{', items, '}', 0) + "\n";
}

base::Result<NamedOrderCertificate> read_order_certificate(std::string_view text) {
  auto root = parse_json(text);
  if (!root) {
    return root.error();
  }
  return CertificateReader(root.value()).read();
}

bool is_order_certificate(std::string_view text) {
  return text.substr(0, 4096).find(fmt::format("\"{}\"", kFormat)) != std::string_view::npos;
}

base::Result<Document> order_steps(const Document& target, const plan::Order& order,
                                   bool is_reversed) {
  const auto spec = order_target(target);
  if (!spec) {
    return spec.error();
  }
  Document document = target;
  gather_modules(document);
  std::vector<model::Step>& plan = document.extension.plan;
  for (const plan::Batch& group : order.steps) {
    const bool is_apart = !order.is_apart.empty() && order.is_apart[plan.size()];
    model::Step& step = plan.emplace_back();
    step.is_apart = is_apart && !is_reversed;
    step.is_any_order = order.is_any_order && group.size() > 1;
    for (const plan::Element element : group) {
      const base::Cell& cell = spec.value().existing[static_cast<std::size_t>(element)];
      (is_reversed ? step.detach : step.attach).push_back(cell);
    }
  }
  if (is_reversed) {
    std::ranges::reverse(plan);
    return document;
  }
  std::vector<base::Cell> later;
  for (std::size_t i = 0; i < spec.value().existing.size(); ++i) {
    if (!order.start.contains(static_cast<plan::Element>(i))) {
      later.push_back(spec.value().existing[i]);
    }
  }
  std::ranges::sort(later);
  std::vector<Step> planned;
  std::vector<OwnParameters> own;
  if (is_any_special(spec.value(), later)) {
    if (std::ranges::any_of(
            plan, [](const model::Step& step) { return step.is_any_order || step.is_apart; })) {
      return base::bad_input(
          "modules that are attached have kinds or masses of their own, which steps in any order, "
          "and apart from the robot, cannot say: expected modules one after another, in one piece");
    }
    own = plan_modules(document, std::exchange(plan, {}), planned);
  }
  leave_out(document, later);
  document.steps = std::move(planned);
  document.extension.own.insert(document.extension.own.end(), own.begin(), own.end());
  return document;
}

}  // namespace holdfast::io
