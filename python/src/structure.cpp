// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "common.hpp"
#include "long_work.hpp"

/// Makes robots of arrays, files and text, writes them, and gives what they consist of.
namespace holdfast::python {
namespace {

SharedStructure share(base::Result<Structure> made, std::string_view file = {}) {
  return std::make_shared<const Structure>(take(std::move(made), file));
}

/// What readers are told beside the file: a dictionary with the keys lattice, robot, allow_unknown,
/// supports, pitch and palette, a text.
io::ReadOptions reading(const py::dict& given) {
  const py::handle lattice = given["lattice"];
  io::ReadOptions options{.robot = utf8_of(given["robot"], "robot"),
                          .allow_unknown = given["allow_unknown"].cast<bool>(),
                          .may_be_in_pieces = true};
  if (const py::handle supports = given["supports"]; !supports.is_none()) {
    options.support = take(io::find_support_level(py::str(supports).cast<std::string>()));
  }
  if (const py::handle pitch = given["pitch"]; !pitch.is_none()) {
    options.mesh_pitch = number_of(pitch, "pitch", 1e-9, 1e9);
  }
  if (const std::string palette = utf8_of(given["palette"], "palette"); !palette.empty()) {
    options.palette = take(io::read_palette(palette), "palette");
  }
  if (const std::string name = utf8_of(lattice, "lattice"); !name.empty()) {
    options.lattice = take(io::find_lattice(name));
  }
  return options;
}

/// Modules that have masses or kinds of their own: step (0 or 1), index there, kind, mass or not a
/// number.
using Own = std::vector<std::tuple<std::size_t, std::size_t, py::object, double>>;

/// Marks modules as fixed. Error: there is no module in one of the cells.
void fix(std::vector<io::ModuleEntry>& modules, std::vector<base::Cell> cells) {
  std::ranges::sort(cells);
  std::vector<char> is_found(cells.size());
  for (io::ModuleEntry& module : modules) {
    const auto place = std::ranges::lower_bound(cells, module.cell);
    if (place != cells.end() && *place == module.cell) {
      module.is_fixed = true;
      is_found[static_cast<std::size_t>(place - cells.begin())] = 1;
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_same_as_before = i > 0 && cells[i] == cells[i - 1];
    if (is_found[i] == 0 && !is_same_as_before) {
      throw Error("fixed: there is no module at " + model::text(cells[i]));
    }
  }
}

/// A mask of as many truths as there are modules, or cells.
void fix(std::vector<io::ModuleEntry>& modules, const py::handle& fixed) {
  const py::array array = py::array::ensure(fixed);
  if (!array || array.dtype().kind() != 'b') {
    fix(modules, cells_of(fixed, "fixed"));
    return;
  }
  if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != modules.size()) {
    throw Error("fixed: a mask has one truth for each of the " + std::to_string(modules.size()) +
                " modules, found is the shape " + py::str(array.attr("shape")).cast<std::string>());
  }
  const auto mask = py::array_t<bool>::ensure(array);
  for (std::size_t i = 0; i < modules.size(); ++i) {
    modules[i].is_fixed = mask.at(static_cast<py::ssize_t>(i));
  }
}

void set_modules(io::Document& document, const std::vector<base::Cell>& cells,
                 const std::vector<base::Cell>& planned) {
  document.modules.resize(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    document.modules[i].cell = cells[i];
  }
  if (!planned.empty()) {
    io::Step& step = document.steps.emplace_back(planned.size());
    for (std::size_t i = 0; i < planned.size(); ++i) {
      step[i].cell = planned[i];
    }
  }
}

/// Makes a structure; `head` is holdfast JSON without modules, for all that is said beside them, or
/// empty.
SharedStructure make(const py::handle& cells, const py::handle& planned, const py::handle& fixed,
                     const py::handle& head, const Own& own) {
  io::Document document;
  if (const std::string json = utf8_of(head, "options"); !json.empty()) {
    document = take(io::read_json(json)).document;
  }
  document.may_be_in_pieces = true;
  const auto existing = cells_of(cells, "cells");
  const auto to_come = planned.is_none() ? std::vector<base::Cell>{} : cells_of(planned, "planned");
  set_modules(document, existing, to_come);
  if (!fixed.is_none()) {
    fix(document.modules, fixed);
  }
  for (const auto& [step, module, kind, mass] : own) {
    document.extension.own.push_back(
        {.step = step,
         .module = module,
         .kind = utf8_of(kind, "kind_of"),
         .mass_kg = std::isnan(mass) ? std::nullopt : std::optional(mass)});
  }
  return share(without_gil([&] { return make_structure(std::move(document)); }));
}

/// The kinds and masses of existing modules, and those of planned modules that are planned again.
std::vector<io::OwnParameters> own_of(const io::Document& document,
                                      const std::vector<base::Cell>& planned) {
  std::map<base::Cell, std::size_t> index;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    index.emplace(planned[i], i);
  }
  std::vector<io::OwnParameters> kept;
  for (io::OwnParameters own : document.extension.own) {
    if (own.step > 0) {
      const auto again = index.find(document.steps[own.step - 1][own.module].cell);
      if (again == index.end()) {
        continue;
      }
      own.step = 1;
      own.module = again->second;
    }
    kept.push_back(std::move(own));
  }
  return kept;
}

/// Leaves out loads on cells without an existing module or one of these planned ones, and bodies
/// of such cells alone.
void keep_what_is_there(io::Document& document, const std::vector<base::Cell>& planned) {
  if (document.extension.payloads.empty() && document.extension.bodies.empty()) {
    return;
  }
  std::set<base::Cell> there(planned.begin(), planned.end());
  for (const io::ModuleEntry& module : document.modules) {
    there.insert(module.cell);
  }
  std::erase_if(document.extension.payloads,
                [&](const model::Payload& payload) { return !there.contains(payload.cell); });
  std::erase_if(document.extension.bodies, [&](const std::vector<base::Cell>& body) {
    return std::ranges::none_of(body, [&](const base::Cell& cell) { return there.contains(cell); });
  });
}

/// The robot with other planned modules and no further steps. Modules that are planned again keep
/// their kinds, masses and loads.
SharedStructure with_planned(const Structure& structure, const py::handle& planned) {
  io::Document document = structure.document;
  const auto cells = cells_of(planned, "planned");
  document.extension.own = own_of(document, cells);
  document.known_answer.reset();
  document.steps.clear();
  document.extension.plan.clear();
  if (!cells.empty()) {
    io::Step& step = document.steps.emplace_back(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      step[i].cell = cells[i];
    }
  }
  keep_what_is_there(document, cells);
  return share(without_gil([&] { return make_structure(std::move(document), structure.name); }));
}

/// The robot with its planned modules attached; further steps move up.
SharedStructure attached(const Structure& structure) {
  io::Document document = structure.document;
  if (!document.steps.empty()) {
    document.known_answer.reset();
    const std::size_t count = document.modules.size();
    for (const io::PlannedEntry& entry : document.steps.front()) {
      document.modules.push_back(
          {.cell = entry.cell, .color = entry.color, .attributes = entry.attributes});
    }
    document.steps.erase(document.steps.begin());
    for (io::OwnParameters& own : document.extension.own) {
      own.module += own.step == 1 ? count : 0;
      own.step -= own.step > 0 ? 1 : 0;
    }
  }
  return share(without_gil([&] { return make_structure(std::move(document), structure.name); }));
}

/// The robot with strengths that are divided by a factor, in place of one that it has.
SharedStructure with_safety_factor(const Structure& structure, double factor) {
  if (!(factor >= 1 && factor <= io::kSafetyFactorMax)) {
    throw Error("safety_factor: expected a number from 1 to 1000, found " +
                std::string(py::str(py::float_(factor))));
  }
  io::Document document = structure.document;
  document.extension.safety_factor = factor;
  return share(without_gil([&] { return make_structure(std::move(document), structure.name); }));
}

py::array modules(const SharedStructure& structure) {
  using model::Module;
  const auto list = structure->robot.modules();
  return view(list.data(), list.size(),
              record({{"cell", "(3,)i4", offsetof(Module, cell)},
                      {"support", "u1", offsetof(Module, support)},
                      {"is_planned", "?", offsetof(Module, is_planned)},
                      {"kind", "u2", offsetof(Module, kind)}},
                     sizeof(Module)),
              py::cast(structure));
}

py::array connections_of(const SharedStructure& structure) {
  using model::Connection;
  const auto list = structure->robot.connections();
  const std::vector<Connection> made(list.begin(), list.end());
  py::array array(record({{"a", "i4", offsetof(Connection, a)},
                          {"b", "i4", offsetof(Connection, b)},
                          {"direction", "u1", offsetof(Connection, direction)}},
                         sizeof(Connection)),
                  static_cast<py::ssize_t>(made.size()), made.data());
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The indices of the modules of each piece of a robot that is in several, the largest first.
py::list pieces_of(const Structure& structure) {
  py::list out;
  for (const model::RobotPiece& piece : structure.robot.pieces()) {
    out.append(py::array_t<std::int32_t>(static_cast<py::ssize_t>(piece.modules.size()),
                                         piece.modules.data()));
  }
  return out;
}

py::array facets(const SharedStructure& structure) {
  using model::Facet;
  const auto list = structure->robot.facets();
  return view(list.data(), list.size(),
              record({{"module", "i4", offsetof(Facet, module)},
                      {"direction", "u1", offsetof(Facet, direction)},
                      {"hold", "u1", offsetof(Facet, touch) + offsetof(model::Touch, hold)}},
                     sizeof(Facet)),
              py::cast(structure));
}

/// The places of the modules' nodes, mm.
py::array_t<double> positions(const Structure& structure) {
  const model::Robot& robot = structure.robot;
  const base::NodePlaces place(robot.lattice(), robot.material().pitch_mm);
  py::array_t<double> out({static_cast<py::ssize_t>(robot.modules().size()), py::ssize_t{3}});
  auto rows = out.mutable_unchecked<2>();
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const std::array<double, 3> at = place(robot.modules()[i].cell);
    for (py::ssize_t k = 0; k < 3; ++k) {
      rows(static_cast<py::ssize_t>(i), k) = at[static_cast<std::size_t>(k)];
    }
  }
  return out;
}

py::array_t<double> masses(const Structure& structure) {
  const std::size_t count = structure.robot.modules().size();
  py::array_t<double> out(static_cast<py::ssize_t>(count));
  auto values = out.mutable_unchecked<1>();
  for (std::size_t i = 0; i < count; ++i) {
    values(static_cast<py::ssize_t>(i)) = structure.robot.mass(i);
  }
  return out;
}

py::dict material(const Structure& structure) {
  py::dict out;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    out[py::str(parameter.key)] = structure.document.material.*parameter.value;
  }
  if (structure.document.extension.pitch_mm) {
    out["pitch_mm"] = *structure.document.extension.pitch_mm;
  }
  return out;
}

/// Unit vectors from a node through each of its facets, in the order of directions.
py::array_t<double> directions(const Structure& structure) {
  const base::Lattice& lattice = structure.robot.lattice();
  const auto range = base::facet_directions(lattice);
  py::array_t<double> out({static_cast<py::ssize_t>(range.size()), py::ssize_t{3}});
  auto rows = out.mutable_unchecked<2>();
  for (const base::Direction direction : range) {
    const std::array<double, 3> vector = base::heading(lattice, direction);
    for (py::ssize_t k = 0; k < 3; ++k) {
      rows(base::index(direction), k) = vector[static_cast<std::size_t>(k)];
    }
  }
  return out;
}

/// Boxes and lists of cells, as numpy arrays: from, to, cells, is_bonded, friction or None.
py::list obstacles(const Structure& structure) {
  py::list out;
  for (const model::Obstacle& obstacle : structure.document.extension.obstacles) {
    py::dict entry;
    if (obstacle.cells.empty()) {
      entry["from"] = py::make_tuple(obstacle.from.x, obstacle.from.y, obstacle.from.z);
      entry["to"] = py::make_tuple(obstacle.to.x, obstacle.to.y, obstacle.to.z);
    } else {
      entry["cells"] = array_of(obstacle.cells);
    }
    entry["hold"] = obstacle.touch.hold == model::Hold::kBonded ? "bonded" : "contact";
    if (obstacle.touch.friction) {
      entry["friction"] = *obstacle.touch.friction;
    }
    out.append(entry);
  }
  return out;
}

py::list catalogue() {
  py::list out;
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    py::list figures;
    for (const model::RobotFigure& figure : robot.figures) {
      figures.append(
          py::make_tuple(figure.key, figure.value, model::name(figure.certainty), figure.source));
    }
    out.append(py::make_tuple(robot.name, robot.title, io::lattice_name(robot.lattice), robot.note,
                              figures));
  }
  return out;
}

py::list foreign_formats() {
  py::list out;
  for (const io::ForeignFormat& format : io::foreign_formats()) {
    out.append(py::make_tuple(format.name, format.endings, format.content, format.lost));
  }
  return out;
}

SharedStructure from_file(const py::handle& given, const py::dict& how) {
  const std::string path = path_of(given);
  const io::ReadOptions options = reading(how);
  auto read = take(without_gil([&] { return load_file(path, 0, options); }), path);
  // The name is the file's, which need not be UTF-8.
  const auto size = static_cast<py::ssize_t>(read.name.size());
  read.name =
      py::reinterpret_steal<py::str>(PyUnicode_DecodeUTF8(read.name.data(), size, "replace"));
  // A robot is a value here, and its copies and pickles have the same reports.
  read.origin = {};
  return std::make_shared<const Structure>(std::move(read));
}

void add_readers(py::class_<Structure, std::shared_ptr<Structure>>& type) {
  type.def_static("make", &make)
      .def_static("load_text",
                  [](const py::handle& given, const py::handle& called, const py::dict& how) {
                    const std::string text = utf8_of(given, "text");
                    const std::string name = utf8_of(called, "name");
                    const io::ReadOptions options = reading(how);
                    return share(without_gil([&] { return load_text(text, name, 0, options); }),
                                 name);
                  })
      .def_static("load_file", &from_file)
      .def_static("generate",
                  [](const py::handle& given, const py::handle& number) {
                    const std::string family = utf8_of(given, "family");
                    const std::size_t size = integer_of(number, "size", 0, model::kModuleCountMax);
                    auto made = without_gil([&]() -> base::Result<Structure> {
                      auto document = generate(family, size);
                      return document ? make_structure(std::move(document).value())
                                      : base::Result<Structure>(document.error());
                    });
                    return share(std::move(made));
                  })
      .def("with_planned", &with_planned)
      .def("attached", &attached)
      .def("with_safety_factor", &with_safety_factor)
      .def_property_readonly("safety_factor",
                             [](const Structure& s) { return s.document.extension.safety_factor; });
}

}  // namespace

void add_structure(py::module_& module) {
  py::class_<Structure, std::shared_ptr<Structure>> type(module, "Structure");
  add_readers(type);
  type.def("json",
           [](const Structure& s) {
             return without_gil([&] { return io::write_json(s.document); });
           })
      .def("visiblesim",
           [](const Structure& s) {
             take(io::visiblesim_shift(s.document));
             return without_gil([&] { return io::write_visiblesim(s.document); });
           })
      .def_property_readonly("name", [](const Structure& s) { return s.name; })
      .def_property_readonly("warnings", [](const Structure& s) { return s.warnings; })
      .def_property_readonly("lattice",
                             [](const Structure& s) { return io::lattice_name(s.robot.lattice()); })
      .def_property_readonly("modules", &modules)
      .def_property_readonly("connections", &connections_of)
      .def_property_readonly("pieces", &pieces_of)
      .def_property_readonly("facets", &facets)
      .def_property_readonly("positions", &positions)
      .def_property_readonly("masses", &masses)
      .def_property_readonly("material", &material)
      .def_property_readonly("directions", &directions)
      .def_property_readonly("obstacles", &obstacles)
      .def_property_readonly("planned_count",
                             [](const Structure& s) { return s.robot.planned_count(); })
      .def_property_readonly("foot_half_width",
                             [](const Structure& s) { return s.robot.foot_half_width_mm(); })
      .def_property_readonly("step_count",
                             [](const Structure& s) { return io::step_count(s.document); })
      .def_property_readonly("gravity", [](const Structure& s) { return s.robot.gravity(); })
      .def_property_readonly("supports",
                             [](const Structure& s) {
                               return s.robot.has_floor() ? std::optional(s.robot.support_z())
                                                          : std::nullopt;
                             })
      .def("has_same_document", [](const Structure& a, const Structure& b) {
        return a.name == b.name && a.document == b.document;
      });
  module.def("lattice_name", [](const py::handle& name) {
    return io::lattice_name(take(io::find_lattice(utf8_of(name, "lattice"))));
  });
  module.def("expect_ending", [](const py::handle& given, const std::string& kind) {
    expect_ending(path_of(given), kind);
  });
  module.def("write_file", [](const py::handle& given, const std::string& text) {
    const std::string path = path_of(given);
    take(without_gil([&] { return write_file(path, text); }), path);
  });
  module.def("catalogue", &catalogue);
  module.def("foreign_formats", &foreign_formats);
  module.def("families", &family_list);
  module.def("version", &version);
}

}  // namespace holdfast::python
