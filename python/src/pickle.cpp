// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <optional>
#include <type_traits>

#include "common.hpp"

/// Writes what a check found as bytes for Python's pickle: the numbers as they lie in memory, for
/// the same version of this package on the same kind of machine. As with all pickles, only those
/// from a trusted source are to be read.
namespace holdfast::python {
namespace {

class Writer {
 public:
  template <class... Value>
  void operator()(Value&... values) {
    (put(values), ...);
  }

  std::string take() { return std::move(bytes_); }

 private:
  template <class Value>
  void put(Value& value);

  void put(std::string& text) { put_list(text); }

  template <class Value>
  void put(std::vector<Value>& list) {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      put_list(list);
    } else {
      put_size(list.size());
      for (Value& value : list) {
        put(value);
      }
    }
  }

  template <class List>
  void put_list(const List& list) {
    put_size(list.size());
    bytes_.append(reinterpret_cast<const char*>(list.data()),
                  list.size() * sizeof(typename List::value_type));
  }

  void put_size(std::size_t size) {
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
  }

  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Value>
  void operator()(Value&... values) {
    (get(values), ...);
  }

  bool is_at_end() const { return bytes_.empty(); }

 private:
  template <class Value>
  void get(Value& value);

  void get(std::string& text) { get_list(text); }

  template <class Value>
  void get(std::vector<Value>& list) {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      get_list(list);
    } else {
      list.resize(get_size(1));
      for (Value& value : list) {
        get(value);
      }
    }
  }

  template <class List>
  void get_list(List& list) {
    list.resize(get_size(sizeof(typename List::value_type)));
    get_bytes(list.data(), list.size() * sizeof(typename List::value_type));
  }

  /// Reads a size and refuses one that is larger than what can follow.
  std::size_t get_size(std::size_t size_each) {
    std::size_t size = 0;
    get_bytes(&size, sizeof size);
    if (size > bytes_.size() / size_each) {
      refuse();
    }
    return size;
  }

  void get_bytes(void* to, std::size_t size) {
    if (size > bytes_.size()) {
      refuse();
    }
    if (size > 0) {
      std::memcpy(to, bytes_.data(), size);
      bytes_.remove_prefix(size);
    }
  }

  [[noreturn]] static void refuse() { throw Error("a pickled report is cut off"); }

  std::string_view bytes_;
};

template <class Archive>
void visit(Archive& archive, verdict::Reason& reason) {
  archive(reason.code, reason.numbers, reason.quoted);
}

template <class Archive>
void visit(Archive& archive, verdict::RigidBody& body) {
  archive(body.is_stable, body.margin_mm, body.edge, body.centre_of_mass, body.polygon);
}

template <class Archive>
void visit_solution(Archive& archive, auto& solution) {
  archive(solution.displacement, solution.displacement_low, solution.alternative, solution.gamma,
          solution.energy_error, solution.contact);
}

using Equilibrium = decltype(verdict::Assessment::equilibrium);
using Solution = decltype(Equilibrium::others)::value_type;

template <class Archive>
void visit(Archive& archive, Solution& solution) {
  visit_solution(archive, solution);
}

template <class Archive>
void visit(Archive& archive, Equilibrium& found) {
  visit_solution(archive, found);
  archive(found.outcome, found.law, found.others, found.facet_force, found.open_but_held_count,
          found.slip, found.free_gamma, found.attempts, found.method, found.precision, found.steps,
          found.iteration_count, found.made_column_count);
}

template <class Archive>
void visit(Archive& archive, verdict::Assessment& found) {
  archive(found.verdict, found.reasons, found.stability_rule, found.simplified, found.rigid,
          found.lean, found.second_order, found.model, found.is_stable, found.connections,
          found.load_ratio_max, found.worst, found.broken, found.gaps_mm, found.gaps,
          found.weight_factor, found.load_ratio_range, found.load_ratio_change, found.contact_model,
          found.several, found.equilibrium, found.pieces);
}

template <class Archive>
void visit(Archive& archive, proof::Proof& proof) {
  auto& [name, law, material, support_z, bits, modules, planned_count, fields] = proof.certificate;
  auto& [is_proved, reason, low, high, connection_count, is_standing, topples, facet_count] =
      proof.verification;
  archive(name, law, material, support_z, bits, modules, planned_count, fields, is_proved, reason,
          low, high, connection_count, is_standing, topples, facet_count, proof.solve_count,
          proof.displacement, proof.displacement_low);
}

template <class Archive>
void visit(Archive& archive, limit::LimitLoad& load) {
  archive(load.outcome, load.low, load.high, load.mechanism.velocities, load.mechanism.yields,
          load.program_count, load.row_count_max);
}

template <class Archive>
void visit(Archive& archive, large::Event& event) {
  archive(event.kind, event.factor, event.modules);
}

template <class Archive>
void visit(Archive& archive, large::State& state) {
  archive(state.factor, state.poses, state.facets, state.facet_force, state.middle_force,
          state.load_ratio, state.gap_mm, state.load_ratio_max, state.worst,
          state.displacement_max_mm, state.rotation_max_rad, state.edge_strain_max);
}

template <class Archive, class Value>
void visit_optional(Archive& archive, std::optional<Value>& value) {
  bool is_there = value.has_value();
  archive(is_there);
  if (is_there) {
    value = value ? std::move(value) : std::optional<Value>(Value{});
    visit(archive, *value);
  }
}

template <class Archive>
void visit(Archive& archive, large::Branch& branch) {
  archive(branch.end, branch.modules, branch.points, branch.last);
  visit_optional(archive, branch.rest);
}

template <class Archive>
void visit(Archive& archive, large::Path& path) {
  archive(path.outcome, path.critical, path.events, path.points, path.last, path.step_count,
          path.solve_count, path.behind);
  visit_optional(archive, path.loaded);
}

template <class Archive>
void visit(Archive& archive, CheckResult& result) {
  archive(result.assessment, result.seconds);
  visit_optional(archive, result.proof);
  archive(result.proof_seconds);
  visit_optional(archive, result.limit);
  archive(result.limit_seconds, result.is_deformed);
  visit_optional(archive, result.deformed);
  archive(result.deformed_seconds);
}

template <class Value>
void Writer::put(Value& value) {
  if constexpr (std::is_trivially_copyable_v<Value>) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  } else {
    visit(*this, value);
  }
}

template <class Value>
void Reader::get(Value& value) {
  if constexpr (std::is_trivially_copyable_v<Value>) {
    get_bytes(&value, sizeof value);
  } else {
    visit(*this, value);
  }
}

/// The head, which has to be the same for bytes to mean the same.
std::string head() {
  return "holdfast " + std::string(version()) + " " + std::to_string(sizeof(CheckResult)) + " ";
}

py::bytes to_bytes(const CheckedStructure& check) {
  CheckResult copy = check.result;
  Writer writer;
  visit(writer, copy);
  return head() + writer.take();
}

SharedCheck from_bytes(const SharedStructure& structure, const std::string& bytes) {
  const std::string expected = head();
  if (!bytes.starts_with(expected)) {
    throw Error("a report that another version of holdfast has pickled cannot be read");
  }
  Reader reader(std::string_view(bytes).substr(expected.size()));
  auto check = std::make_shared<CheckedStructure>(CheckedStructure{structure, {}});
  visit(reader, check->result);
  const auto& robot = structure->robot;
  const auto& found = check->result.assessment;
  const bool fits = reader.is_at_end() && (found.connections.empty() ||
                                           found.connections.size() == robot.connections().size());
  if (!fits) {
    throw Error("a pickled report does not belong to its robot");
  }
  return check;
}

}  // namespace

void add_pickle(py::module_& module) {
  module.def("to_bytes", &to_bytes);
  module.def("from_bytes", &from_bytes);
}

}  // namespace holdfast::python
