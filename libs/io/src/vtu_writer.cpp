// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "holdfast/io/picture.hpp"
#include "module_paint.hpp"

// Cells are the modules in the robot's order, then the connections in theirs; so are the points,
// eight corners or two ends. VTK's ASCII reader loses everything from the first "nan" or "inf" on
// without an error, so what is not known is written as 0, and has_loads says so.
namespace holdfast::io {
namespace {

using Triple = std::array<double, 3>;

constexpr std::size_t kCornerCount = 8;
constexpr int kVtkLine = 3;
constexpr int kVtkHexahedron = 12;

/// The corners of a cube in VTK's order, as fractions of the pitch.
constexpr std::array<Triple, kCornerCount> kCorners = {{{-0.5, -0.5, -0.5},
                                                        {0.5, -0.5, -0.5},
                                                        {0.5, 0.5, -0.5},
                                                        {-0.5, 0.5, -0.5},
                                                        {-0.5, -0.5, 0.5},
                                                        {0.5, -0.5, 0.5},
                                                        {0.5, 0.5, 0.5},
                                                        {-0.5, 0.5, 0.5}}};

void append(std::string& out, double value) {
  // Adding zero takes the sign from minus zero.
  fmt::format_to(std::back_inserter(out), "{:.9g}", std::isfinite(value) ? value + 0.0 : 0.0);
}

void append(std::string& out, std::int64_t value) {
  fmt::format_to(std::back_inserter(out), "{}", value);
}

void append(std::string& out, int value) { append(out, static_cast<std::int64_t>(value)); }

void append(std::string& out, bool value) { out += value ? '1' : '0'; }

template <class Value>
void append(std::string& out, const std::array<Value, 3>& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    out += i == 0 ? "" : " ";
    append(out, values[i]);
  }
}

Triple scaled(double factor, const Triple& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

Triple sum(const Triple& a, const Triple& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Triple first_half(const base::Vec6<double>& vector) { return {vector[0], vector[1], vector[2]}; }

Triple second_half(const base::Vec6<double>& vector) { return {vector[3], vector[4], vector[5]}; }

/// -1 on modules that do not rest on the ground, else how many corners press: 0 (open), 1, 2 (an
/// edge) or 4 (closed).
int pressing_corners(model::Support support, const mechanics::ContactState& state) {
  if (support != model::Support::kGround) {
    return -1;
  }
  if (!state.pressed) {
    return 0;
  }
  return (state.tilt_x != 0 ? 1 : 2) * (state.tilt_y != 0 ? 1 : 2);
}

class Writer {
 public:
  Writer(const model::Robot& robot, const verdict::Assessment& assessment)
      : robot_(robot),
        assessment_(assessment),
        paints_(paint_modules(robot, assessment)),
        is_broken_(robot.connections().size(), false),
        has_loads_(has_loads(robot, assessment)) {
    for (const std::size_t connection : assessment.broken) {
      is_broken_[connection] = true;
    }
  }

  std::string write() {
    const std::size_t modules = robot_.modules().size();
    const std::size_t connections = robot_.connections().size();
    out_ =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
    write_field_data();
    out_ += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                        kCornerCount * modules + 2 * connections, modules + connections);
    write_points();
    write_cells();
    out_ += "<PointData Vectors=\"displacement_mm\">\n";
    write_displacement();
    out_ += "</PointData>\n<CellData Scalars=\"load_ratio\">\n";
    write_facts();
    write_loads();
    write_ground();
    out_ += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return std::move(out_);
  }

 private:
  void open_array(const char* type, const char* name, std::size_t components) {
    out_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
        "format=\"ascii\">\n",
        type, name, components);
  }

  void close_array() { out_ += "</DataArray>\n"; }

  /// One line per cell: `of_module` and `of_connection` give its value for an index.
  template <class OfModule, class OfConnection>
  void write_cell_array(const char* type, const char* name, OfModule of_module,
                        OfConnection of_connection) {
    using Value = decltype(of_module(std::size_t{}));
    static_assert(std::is_same_v<Value, decltype(of_connection(std::size_t{}))>);
    open_array(type, name, std::is_arithmetic_v<Value> ? 1 : 3);
    for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
      append(out_, of_module(i));
      out_ += '\n';
    }
    for (std::size_t i = 0; i < robot_.connections().size(); ++i) {
      append(out_, of_connection(i));
      out_ += '\n';
    }
    close_array();
  }

  /// One line per point; `at_corner` gets a module and a corner, `at_end` a module.
  template <class AtCorner, class AtEnd>
  void write_point_array(const char* name, AtCorner at_corner, AtEnd at_end) {
    open_array("Float64", name, 3);
    for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
      for (const Triple& corner : kCorners) {
        append(out_, at_corner(i, scaled(robot_.material().pitch_mm, corner)));
        out_ += '\n';
      }
    }
    for (const model::Connection& connection : robot_.connections()) {
      for (const std::int32_t end : {connection.a, connection.b}) {
        append(out_, at_end(static_cast<std::size_t>(end)));
        out_ += '\n';
      }
    }
    close_array();
  }

  /// Strings are written as character codes with a zero at the end.
  void write_field_data() {
    out_ +=
        "<FieldData>\n<Array type=\"String\" Name=\"verdict\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n";
    for (const char* letter = verdict::name(assessment_.verdict); *letter != '\0'; ++letter) {
      out_ += fmt::format("{} ", static_cast<int>(*letter));
    }
    out_ += "0\n</Array>\n";
    out_ +=
        "<DataArray type=\"Float64\" Name=\"load_ratio_max\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n";
    append(out_, has_loads_ ? assessment_.load_ratio_max.value_or(0) : 0);
    out_ +=
        "\n</DataArray>\n<DataArray type=\"UInt8\" Name=\"has_loads\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n";
    append(out_, has_loads_);
    out_ += "\n</DataArray>\n</FieldData>\n";
  }

  Triple centre(std::size_t module) const {
    const base::Cell& cell = robot_.modules()[module].cell;
    return scaled(
        robot_.material().pitch_mm,
        {static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)});
  }

  void write_points() {
    out_ += "<Points>\n";
    write_point_array(
        "Points",
        [&](std::size_t module, const Triple& corner) { return sum(centre(module), corner); },
        [&](std::size_t module) { return centre(module); });
    out_ += "</Points>\n";
  }

  void write_cells() {
    out_ += "<Cells>\n";
    open_array("Int64", "connectivity", 1);
    const std::size_t modules = robot_.modules().size();
    const std::size_t points = kCornerCount * modules + 2 * robot_.connections().size();
    for (std::size_t i = 0; i < points; ++i) {
      const bool is_last =
          i < kCornerCount * modules ? i % kCornerCount == kCornerCount - 1 : i % 2 == 1;
      append(out_, static_cast<std::int64_t>(i));
      out_ += is_last ? '\n' : ' ';
    }
    close_array();
    write_cell_array(
        "Int64", "offsets",
        [&](std::size_t i) { return static_cast<std::int64_t>(kCornerCount * (i + 1)); },
        [&](std::size_t i) {
          return static_cast<std::int64_t>(kCornerCount * modules + 2 * (i + 1));
        });
    write_cell_array(
        "UInt8", "types", [](std::size_t) { return kVtkHexahedron; },
        [](std::size_t) { return kVtkLine; });
    out_ += "</Cells>\n";
  }

  base::Vec6<double> displacement(std::size_t module) const {
    const auto& all = assessment_.equilibrium.displacement;
    return has_loads_ && all.size() == paints_.size() ? all[module] : base::Vec6<double>{};
  }

  /// Modules move as rigid bodies: u + theta x r.
  void write_displacement() {
    write_point_array(
        "displacement_mm",
        [&](std::size_t module, const Triple& corner) {
          const base::Vec6<double> u = displacement(module);
          return sum(first_half(u), cross(second_half(u), corner));
        },
        [&](std::size_t module) { return first_half(displacement(module)); });
  }

  /// A yes or no per module, and per connection whether it is so at either end.
  template <class Fact>
  void write_fact(const char* name, Fact fact) {
    write_cell_array(
        "UInt8", name, [&](std::size_t i) { return fact(robot_.modules()[i]); },
        [&](std::size_t i) {
          const auto& [a, b, direction] = robot_.connections()[i];
          return fact(robot_.modules()[static_cast<std::size_t>(a)]) ||
                 fact(robot_.modules()[static_cast<std::size_t>(b)]);
        });
  }

  void write_facts() {
    write_cell_array(
        "UInt8", "kind", [](std::size_t) { return 0; }, [](std::size_t) { return 1; });
    const auto index = [](std::size_t i) { return static_cast<std::int64_t>(i); };
    write_cell_array("Int32", "index", index, index);
    const auto lattice = [&](std::size_t module) {
      const base::Cell& cell = robot_.modules()[module].cell;
      return std::array<std::int64_t, 3>{cell.x, cell.y, cell.z};
    };
    write_cell_array("Int32", "cell", lattice, [&](std::size_t i) {
      return lattice(static_cast<std::size_t>(robot_.connections()[i].a));
    });
    write_fact("planned", [](const model::Module& module) { return module.is_planned; });
    write_fact("fixed", [](const model::Module& module) {
      return module.support == model::Support::kFixed;
    });
    write_cell_array(
        "UInt8", "on_ground",
        [&](std::size_t i) { return robot_.modules()[i].support == model::Support::kGround; },
        [](std::size_t) { return false; });
  }

  /// A number per connection; modules have none, which is 0.
  void write_connection_number(const char* name, double verdict::ConnectionResult::*member) {
    write_cell_array(
        "Float64", name, [](std::size_t) { return 0.0; },
        [&](std::size_t i) { return has_loads_ ? assessment_.connections[i].*member : 0.0; });
  }

  void write_loads() {
    write_cell_array(
        "Float64", "load_ratio", [&](std::size_t i) { return paints_[i].worst_ratio; },
        [&](std::size_t i) { return has_loads_ ? assessment_.connections[i].load_ratio : 0.0; });
    write_cell_array(
        "UInt8", "broken", [](std::size_t) { return false; },
        [&](std::size_t i) { return static_cast<bool>(is_broken_[i]); });
    write_connection_number("axial_n", &verdict::ConnectionResult::axial_n);
    write_connection_number("bending_nmm", &verdict::ConnectionResult::bending_nmm);
    write_connection_number("shear_n", &verdict::ConnectionResult::shear_n);
    write_connection_number("torsion_nmm", &verdict::ConnectionResult::torsion_nmm);
  }

  base::Vec6<double> ground_force(std::size_t module) const {
    const auto& all = assessment_.equilibrium.ground_force;
    return has_loads_ && all.size() == paints_.size() ? all[module] : base::Vec6<double>{};
  }

  void write_ground() {
    const auto none = [](std::size_t) { return Triple{}; };
    const auto& states = assessment_.equilibrium.contact;
    const bool is_known = has_loads_ && states.size() == paints_.size();
    write_cell_array(
        "Int8", "contact",
        [&](std::size_t i) {
          return is_known ? pressing_corners(robot_.modules()[i].support, states[i]) : -1;
        },
        [](std::size_t) { return -1; });
    write_cell_array(
        "Float64", "ground_force_n", [&](std::size_t i) { return first_half(ground_force(i)); },
        none);
    write_cell_array(
        "Float64", "ground_torque_nmm", [&](std::size_t i) { return second_half(ground_force(i)); },
        none);
    write_cell_array(
        "Float64", "rotation_rad", [&](std::size_t i) { return second_half(displacement(i)); },
        none);
  }

  const model::Robot& robot_;
  const verdict::Assessment& assessment_;
  std::vector<ModulePaint> paints_;
  std::vector<bool> is_broken_;  ///< By connection.
  bool has_loads_ = false;
  std::string out_;
};

}  // namespace

std::string write_vtu(const model::Robot& robot, const verdict::Assessment& assessment) {
  return Writer(robot, assessment).write();
}

}  // namespace holdfast::io
