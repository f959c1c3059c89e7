// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

#include "check_options.hpp"
#include "common.hpp"
#include "holdfast/check_formats.hpp"
#include "holdfast/figure_file.hpp"
#include "long_work.hpp"

/// Checks and what they find.
namespace holdfast::python {

// Bounds as of the command line.
int thread_count_of(const py::handle& threads) {
  return static_cast<int>(integer_of(threads, "threads", 0, 64));
}

CheckOptions check_options(const py::handle& threads, const py::handle& memory, bool is_bonded) {
  const double memory_gb = number_of(memory, "memory", 0.01, 1024);
  return {.is_bonded = is_bonded,
          .thread_count = thread_count_of(threads),
          .memory_bytes_max = static_cast<std::size_t>(memory_gb * 1073741824.0)};
}

namespace {

SharedCheck check_shared(const SharedStructure& structure, const py::handle& threads,
                         const py::handle& memory, bool is_bonded, bool is_limit_wanted,
                         const py::handle& limit_seconds, bool is_proof_wanted,
                         bool is_deformed_wanted, const py::handle& factor_max,
                         bool is_followed_behind, py::object progress) {
  CheckOptions options = check_options(threads, memory, is_bonded);
  if (is_deformed_wanted && is_proof_wanted) {
    throw Error("deformed and proof do not go together: a proof is one of linear theory");
  }
  if (is_deformed_wanted || is_proof_wanted || is_limit_wanted) {
    expect_one_piece(*structure, is_deformed_wanted ? "deformed"
                                 : is_proof_wanted  ? "proof"
                                                    : "limit");
  }
  options.is_deformed_wanted = is_deformed_wanted;
  if (is_followed_behind && !is_deformed_wanted) {
    throw Error(
        "follow requires deformed: it goes on behind the loss of stability that this finds");
  }
  options.is_followed_behind = is_followed_behind;
  options.factor_max = number_of(factor_max, "up_to", 1, 1e6);
  options.is_limit_wanted = is_limit_wanted;
  options.limit_seconds_max =
      number_of(limit_seconds, "limit_seconds", 0, std::numeric_limits<double>::infinity());
  options.is_proof_wanted = is_proof_wanted;
  Watch watch(std::move(progress));
  options.progress = [&](int iteration, double error) { watch(iteration, error); };
  options.limit_progress = [&](double low, double high) { watch(low, high); };
  return without_gil(watch, [&] {
    return std::make_shared<CheckedStructure>(structure, check(*structure, options));
  });
}

std::vector<SharedCheck> check_list(const std::vector<SharedStructure>& structures,
                                    const py::handle& threads, const py::handle& memory,
                                    bool is_bonded, py::object progress) {
  const CheckOptions options = check_options(threads, memory, is_bonded);
  std::vector<const model::Robot*> robots;
  for (const SharedStructure& structure : structures) {
    robots.push_back(&structure->robot);
  }
  Watch watch(std::move(progress));
  return without_gil(watch, [&] {
    std::vector<CheckResult> results = check_many(robots, options, [&](std::size_t done) {
      done < robots.size() ? watch(done, robots.size()) : watch.tell(done, robots.size());
    });
    std::vector<SharedCheck> checks;
    checks.reserve(results.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      checks.push_back(std::make_shared<CheckedStructure>(structures[i], std::move(results[i])));
    }
    return checks;
  });
}

/// Six numbers of which three belong together.
py::dtype pairs_of_vectors(const char* first, const char* second) {
  return record({{first, "(3,)f8", 0}, {second, "(3,)f8", 3 * sizeof(double)}}, 6 * sizeof(double));
}

py::array connections(const SharedCheck& check) {
  using verdict::ConnectionResult;
  const auto& list = check->result.assessment.connections;
  return view(list.data(), list.size(),
              record({{"load_ratio", "f8", offsetof(ConnectionResult, load_ratio)},
                      {"axial_n", "f8", offsetof(ConnectionResult, axial_n)},
                      {"bending_nmm", "f8", offsetof(ConnectionResult, bending_nmm)},
                      {"shear_n", "f8", offsetof(ConnectionResult, shear_n)},
                      {"torsion_nmm", "f8", offsetof(ConnectionResult, torsion_nmm)}},
                     sizeof(ConnectionResult)),
              py::cast(check));
}

py::array displacements(const SharedCheck& check) {
  const auto& list = check->result.assessment.equilibrium.displacement;
  return view(list.data(), list.size(), pairs_of_vectors("translation_mm", "rotation_rad"),
              py::cast(check));
}

py::array facet_forces(const SharedCheck& check) {
  const auto& list = check->result.assessment.equilibrium.facet_force;
  return view(list.data(), list.size(), pairs_of_vectors("force_n", "moment_nmm"), py::cast(check));
}

py::array ground_forces(const SharedCheck& check) {
  const auto list = holdfast::ground_forces(check->structure->robot, check->result);
  py::array array(pairs_of_vectors("force_n", "moment_nmm"), list.size(), list.data());
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// What is known of each piece of a robot that is in several.
py::list pieces(const CheckedStructure& check) {
  py::list out;
  for (const verdict::PieceAnswer& piece : check.result.assessment.pieces) {
    out.append(py::make_tuple(piece.module_count,
                              py::make_tuple(piece.first.x, piece.first.y, piece.first.z),
                              verdict::name(piece.verdict), piece.load_ratio_max, piece.margin_mm));
  }
  return out;
}

/// The contacts of all facets.
py::array contacts(const SharedCheck& check) {
  const auto& list = check->result.assessment.equilibrium.contact;
  using State = std::decay_t<decltype(list.front())>;
  return view(list.data(), list.size(),
              record({{"is_pressed", "?", offsetof(State, pressed)},
                      {"tilt_x", "i1", offsetof(State, tilt_x)},
                      {"tilt_y", "i1", offsetof(State, tilt_y)}},
                     sizeof(State)),
              py::cast(check));
}

std::vector<std::string> limits(const CheckedStructure& check) {
  std::vector<std::string> out;
  for (const model::Limit limit :
       connection_limits(check.structure->robot, check.result.assessment)) {
    out.emplace_back(model::name(limit));
  }
  return out;
}

std::vector<std::string> reasons(const CheckedStructure& check) {
  std::vector<std::string> out;
  for (const verdict::Reason& reason : check.result.assessment.reasons) {
    out.push_back(io::reason_text(check.structure->robot, reason));
  }
  return out;
}

py::dict rigid_body(const verdict::RigidBody& body) {
  py::dict out;
  out["is_stable"] = body.is_stable;
  out["margin_mm"] = body.margin_mm;
  out["centre_of_mass_mm"] = py::make_tuple(body.centre_of_mass.x, body.centre_of_mass.y);
  const auto points = [](const auto& list) {
    py::array_t<double> array({static_cast<py::ssize_t>(list.size()), py::ssize_t{2}});
    auto rows = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < list.size(); ++i) {
      rows(static_cast<py::ssize_t>(i), 0) = list[i].x;
      rows(static_cast<py::ssize_t>(i), 1) = list[i].y;
    }
    return array;
  };
  out["polygon_mm"] = points(body.polygon);
  out["edge_mm"] = body.edge ? py::object(points(*body.edge)) : py::none();
  return out;
}

py::dict stability(const CheckedStructure& check) {
  const verdict::Assessment& found = check.result.assessment;
  py::dict out = rigid_body(found.simplified);
  out["is_stable"] = verdict::known_stability(found);
  out["is_stable_by_model"] =
      found.model.is_settled ? py::object(py::bool_(found.model.is_stable)) : py::none();
  const limit::RigidStability& rigid = found.rigid;
  out["rigid"] = limit::name(rigid.answer);
  out["friction_needed"] = rigid.friction_needed;
  out["tilt_margin_deg"] = rigid.tilt_margin_deg;
  out["motion"] = rigid.motion ? py::object(py::str(limit::text(*rigid.motion))) : py::none();
  return out;
}

/// The columns are verdict, load ratio, margin, weight factor, modules and seconds; not a number
/// where none is known.
py::tuple row(const CheckedStructure& check) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const verdict::Assessment& found = check.result.assessment;
  return py::make_tuple(static_cast<int>(found.verdict), found.load_ratio_max.value_or(kNone),
                        found.simplified.margin_mm.value_or(kNone),
                        found.weight_factor.value_or(kNone),
                        check.structure->robot.modules().size(), check.result.seconds);
}

py::object limit_load(const CheckedStructure& check) {
  if (!check.result.limit) {
    return py::none();
  }
  py::dict out;
  out["outcome"] = limit::name(check.result.limit->outcome);
  const double high = check.result.limit->high;
  out["low"] = check.result.limit->low;
  out["high"] = high < limit::kFactorMax ? py::object(py::float_(high)) : py::none();
  return out;
}

/// The keys of the JSON report.
py::object second_order(const CheckedStructure& check) {
  const auto& second = check.result.assessment.second_order;
  if (!second) {
    return py::none();
  }
  const auto known = [](const std::optional<double>& number) -> py::object {
    return number && std::isfinite(*number) ? py::object(py::float_(*number)) : py::none();
  };
  using Answer = decltype(verdict::SecondOrder::answer);
  const auto bound = [&](Answer answer) {
    return known(second->answer == answer ? std::optional(second->factor) : std::nullopt);
  };
  py::dict out;
  out["buckling_factor"] = known(second->buckling_factor());
  out["buckling_factor_above"] = bound(Answer::kAbove);
  out["buckling_factor_at_most"] = bound(Answer::kAtMost);
  out["elastic_modulus_needed_mpa"] = known(second->elastic_modulus_needed_mpa());
  out["mode"] = py::none();
  if (second->mode) {
    const auto& [cell, direction] = *second->mode;
    py::dict mode;
    mode["cell"] = py::make_tuple(cell.x, cell.y, cell.z);
    mode["direction"] = py::make_tuple(direction[0], direction[1], direction[2]);
    out["mode"] = mode;
  }
  out["load_ratio_max"] = known(second->load_ratio_max);
  out["rotation_max_rad"] = second->rotation_max_rad;
  out["displacement_max_mm"] = second->displacement_max_mm;
  out["edge_strain_max"] = second->edge_strain_max;
  out["facet_reserve_max"] = known(second->facet_reserve_max);
  out["trusted"] = second->trust == verdict::Trust::kNotCertain
                       ? py::object(py::none())
                       : py::object(py::bool_(second->trust == verdict::Trust::kTrusted));
  return out;
}

template <class Write>
std::string text_of(const Write& write) {
  return without_gil([&] {
    std::ostringstream out;
    write(out);
    return std::move(out).str();
  });
}

/// Writes a file, whole or not at all.
void save(const CheckedStructure& check, const py::handle& given, const std::string& kind) {
  const std::string path = path_of(given);
  const CheckFormat& format = *find_check_format(kind);
  take(find_foreign_ending(format.file, path), path);
  const auto error = without_gil([&] {
    return write_file(
        path, [&](std::ostream& out) { format.write(out, *check.structure, check.result, {}); });
  });
  take(error, path);
}

/// Writes what the ending of a file says: a format of the table, or the picture.
void save_by_ending(const CheckedStructure& check, const py::handle& given) {
  const std::string path = path_of(given);
  if (const CheckFormat* const format = find_check_format_of(path)) {
    save(check, given, std::string(format->name));
    return;
  }
  if (!has_ending_of(FileFormat::kFigure, path)) {
    std::string endings;
    for (const CheckFormat& format : check_formats()) {
      endings += "." + std::string(format.name) + ", ";
    }
    throw Error("expected a file that ends in " + endings + ".svg, .png or .pdf, found " +
                io::one_line(path));
  }
  take(without_gil([&] { return write_figure(path, picture_svg(*check.structure, check.result)); }),
       path);
}

void add_arrays(py::class_<CheckedStructure, std::shared_ptr<CheckedStructure>>& type) {
  type.def_property_readonly("connections", &connections)
      .def_property_readonly("displacements", &displacements)
      .def_property_readonly("facet_forces", &facet_forces)
      .def_property_readonly("pieces", &pieces)
      .def_property_readonly("ground_forces", &ground_forces)
      .def_property_readonly("contacts", &contacts)
      .def_property_readonly("limits", &limits);
}

void add_texts(py::class_<CheckedStructure, std::shared_ptr<CheckedStructure>>& type) {
  type.def("json",
           [](const CheckedStructure& c) {
             return without_gil([&] { return report_json(*c.structure, c.result); });
           })
      .def("text",
           [](const CheckedStructure& c) {
             return without_gil([&] { return report_text(*c.structure, c.result); });
           })
      .def("svg",
           [](const CheckedStructure& c, const io::FigureOptions& figure) {
             return without_gil([&] { return picture_svg(*c.structure, c.result, figure); });
           })
      .def("csv",
           [](const CheckedStructure& c) {
             return text_of([&](std::ostream& out) {
               find_check_format("csv")->write(out, *c.structure, c.result, {});
             });
           })
      .def("certificate",
           [](const CheckedStructure& c) { return take(certificate_text(*c.structure, c.result)); })
      .def("save", &save)
      .def("save_by_ending", &save_by_ending);
}

}  // namespace

void add_check(py::module_& module) {
  py::class_<CheckedStructure, std::shared_ptr<CheckedStructure>> type(module, "Check");
  add_arrays(type);
  add_texts(type);
  type.def_property_readonly("row", &row)
      .def_property_readonly("structure", [](const CheckedStructure& c) { return c.structure; })
      .def_property_readonly(
          "verdict",
          [](const CheckedStructure& c) { return static_cast<int>(c.result.assessment.verdict); })
      .def_property_readonly("reasons", &reasons)
      .def_property_readonly(
          "load_ratio_max",
          [](const CheckedStructure& c) { return c.result.assessment.load_ratio_max; })
      .def_property_readonly("worst",
                             [](const CheckedStructure& c) { return c.result.assessment.worst; })
      .def_property_readonly("broken",
                             [](const CheckedStructure& c) { return c.result.assessment.broken; })
      .def_property_readonly(
          "weight_factor",
          [](const CheckedStructure& c) { return c.result.assessment.weight_factor; })
      .def_property_readonly("contact_model",
                             [](const CheckedStructure& c) {
                               return verdict::name(c.result.assessment.contact_model);
                             })
      .def_property_readonly("stability", &stability)
      .def_property_readonly("limit_load", &limit_load)
      .def_property_readonly("second_order", &second_order)
      .def_property_readonly("seconds", [](const CheckedStructure& c) {
        return py::make_tuple(c.result.seconds, c.result.proof_seconds, c.result.limit_seconds);
      });
  module.def("check", &check_shared);
  module.def("check_many", &check_list);
}

}  // namespace holdfast::python
