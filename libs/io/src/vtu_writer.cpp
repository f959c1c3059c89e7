// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <type_traits>

#include "holdfast/io/picture.hpp"
#include "module_paint.hpp"
#include "vtu_arrays.hpp"

// Cells are the modules in the robot's order, then the connections in theirs. Points are eight
// corners of each module, then the centre of each, between which the connections run. What is not
// known is written as 0, and has_loads says so.
namespace holdfast::io {
namespace {

using Triple = std::array<double, 3>;

constexpr std::size_t kCornerCount = 8;
constexpr std::uint8_t kVtkLine = 3;
constexpr std::uint8_t kVtkHexahedron = 12;
constexpr std::int8_t kNotOnGround = -1;

/// The corners of a cube in VTK's order, as fractions of the pitch.
constexpr std::array<Triple, kCornerCount> kCorners = {{{-0.5, -0.5, -0.5},
                                                        {0.5, -0.5, -0.5},
                                                        {0.5, 0.5, -0.5},
                                                        {-0.5, 0.5, -0.5},
                                                        {-0.5, -0.5, 0.5},
                                                        {0.5, -0.5, 0.5},
                                                        {0.5, 0.5, 0.5},
                                                        {-0.5, 0.5, 0.5}}};

/// What is not finite is written as 0, and what is is rounded to 32 bits, more than nine digits:
/// fewer bits take less room and time.
double written(double value) {
  constexpr std::uint64_t kDropped = 21;
  // Adding zero takes the sign from minus zero.
  const auto bits = std::bit_cast<std::uint64_t>(std::isfinite(value) ? value + 0.0 : 0.0);
  const std::uint64_t rounded = (bits + (std::uint64_t{1} << (kDropped - 1))) >> kDropped;
  return std::bit_cast<double>(rounded << kDropped);
}

Triple written(const Triple& values) {
  return {written(values[0]), written(values[1]), written(values[2])};
}

template <class Value>
Value written(const Value& value) {
  return value;
}

/// VTK's word for a type.
template <class Number>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<double> = "Float64";
template <>
constexpr const char* kTypeName<std::int64_t> = "Int64";
template <>
constexpr const char* kTypeName<std::int32_t> = "Int32";
template <>
constexpr const char* kTypeName<std::int8_t> = "Int8";
template <>
constexpr const char* kTypeName<std::uint8_t> = "UInt8";

/// An array with the value of_tuple(i), a number or three, at place i.
template <class OfTuple>
VtuArray make_array(const char* name, std::size_t count, OfTuple of_tuple) {
  using Value = decltype(of_tuple(std::size_t{}));
  constexpr bool kIsTriple = !std::is_arithmetic_v<Value>;
  using Number = typename std::conditional_t<kIsTriple, Value, std::array<Value, 1>>::value_type;
  return {.type = kTypeName<Number>,
          .name = name,
          .components = kIsTriple ? 3 : 1,
          .value_bytes = sizeof(Number),
          .tuple_count = count,
          .append = [of_tuple](std::size_t begin, std::size_t end, std::string& out) {
            out.resize((end - begin) * sizeof(Value));
            for (std::size_t i = begin; i < end; ++i) {
              const Value value = written(of_tuple(i));
              std::memcpy(out.data() + (i - begin) * sizeof value, &value, sizeof value);
            }
          }};
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
std::int8_t pressing_corners(model::Support support, const mechanics::ContactState& state) {
  if (support != model::Support::kGround) {
    return kNotOnGround;
  }
  if (!state.pressed) {
    return 0;
  }
  return static_cast<std::int8_t>((state.tilt_x != 0 ? 1 : 2) * (state.tilt_y != 0 ? 1 : 2));
}

/// A yes or no, as arrays have it.
std::uint8_t flag(bool is_so) { return is_so ? 1 : 0; }

class Writer {
 public:
  Writer(std::ostream& out, const model::Robot& robot, const verdict::Assessment& assessment,
         const WriteOptions& options)
      : out_(out),
        robot_(robot),
        assessment_(assessment),
        module_count_(robot.modules().size()),
        connection_count_(robot.connections().size()),
        paints_(paint_modules(robot, assessment)),
        is_broken_(connection_count_, false),
        has_loads_(has_loads(robot, assessment)),
        arrays_(out, options) {
    for (const std::size_t connection : assessment.broken) {
      is_broken_[connection] = true;
    }
  }

  void write() {
    out_ << "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\""
         << VtuArrays::compressor() << ">\n<UnstructuredGrid>\n";
    write_field_data();
    out_ << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", point_count(),
                        module_count_ + connection_count_);
    out_ << "<Points>\n";
    announce_points();
    out_ << "</Points>\n<Cells>\n";
    announce_cells();
    out_ << "</Cells>\n<PointData Vectors=\"displacement_mm\">\n";
    announce_displacement();
    out_ << "</PointData>\n<CellData Scalars=\"load_ratio\">\n";
    announce_facts();
    announce_loads();
    announce_ground();
    out_ << "</CellData>\n</Piece>\n</UnstructuredGrid>\n";
    arrays_.write();
    out_ << "</VTKFile>\n";
  }

 private:
  /// Lines run between the centres of modules; without lines there are corners only.
  std::size_t point_count() const {
    return kCornerCount * module_count_ + (connection_count_ > 0 ? module_count_ : 0);
  }

  /// `of_module` and `of_connection` give the value of a cell for an index.
  template <class OfModule, class OfConnection>
  void announce_cell_array(const char* name, OfModule of_module, OfConnection of_connection) {
    static_assert(
        std::is_same_v<decltype(of_module(std::size_t{})), decltype(of_connection(std::size_t{}))>);
    arrays_.announce(make_array(name, module_count_ + connection_count_,
                                [modules = module_count_, of_module, of_connection](std::size_t i) {
                                  return i < modules ? of_module(i) : of_connection(i - modules);
                                }));
  }

  /// `at_corner` gets a module and a corner, `at_centre` a module.
  template <class AtCorner, class AtCentre>
  void announce_point_array(const char* name, AtCorner at_corner, AtCentre at_centre) {
    const double pitch = robot_.material().pitch_mm;
    arrays_.announce(make_array(
        name, point_count(),
        [pitch, corners = kCornerCount * module_count_, at_corner, at_centre](std::size_t i) {
          return i < corners
                     ? at_corner(i / kCornerCount, scaled(pitch, kCorners[i % kCornerCount]))
                     : at_centre(i - corners);
        }));
  }

  /// Strings are written as character codes with a zero at the end.
  void write_field_data() {
    out_ << "<FieldData>\n<Array type=\"String\" Name=\"verdict\" NumberOfTuples=\"1\" "
            "format=\"ascii\">\n";
    for (const char* letter = verdict::name(assessment_.verdict); *letter != '\0'; ++letter) {
      out_ << fmt::format("{} ", static_cast<int>(*letter));
    }
    const double largest = has_loads_ ? assessment_.load_ratio_max.value_or(0) : 0;
    out_ << fmt::format(
        "0\n</Array>\n<DataArray type=\"Float64\" Name=\"load_ratio_max\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n{:.9g}\n</DataArray>\n<DataArray type=\"UInt8\" Name=\"has_loads\" "
        "NumberOfTuples=\"1\" format=\"ascii\">\n{}\n</DataArray>\n</FieldData>\n",
        std::isfinite(largest) ? largest + 0.0 : 0.0, flag(has_loads_));
  }

  Triple centre(std::size_t module) const {
    const base::Cell& cell = robot_.modules()[module].cell;
    return scaled(
        robot_.material().pitch_mm,
        {static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)});
  }

  void announce_points() {
    announce_point_array(
        "Points",
        [this](std::size_t module, const Triple& corner) { return sum(centre(module), corner); },
        [this](std::size_t module) { return centre(module); });
  }

  void announce_cells() {
    const std::size_t corners = kCornerCount * module_count_;
    arrays_.announce(
        make_array("connectivity", corners + 2 * connection_count_, [this, corners](std::size_t i) {
          if (i < corners) {
            return static_cast<std::int64_t>(i);
          }
          const model::Connection& pair = robot_.connections()[(i - corners) / 2];
          return static_cast<std::int64_t>(corners) + ((i - corners) % 2 == 0 ? pair.a : pair.b);
        }));
    announce_cell_array(
        "offsets", [](std::size_t i) { return static_cast<std::int64_t>(kCornerCount * (i + 1)); },
        [corners](std::size_t i) { return static_cast<std::int64_t>(corners + 2 * (i + 1)); });
    announce_cell_array(
        "types", [](std::size_t) { return kVtkHexahedron; }, [](std::size_t) { return kVtkLine; });
  }

  base::Vec6<double> displacement(std::size_t module) const {
    const auto& all = assessment_.equilibrium.displacement;
    return has_loads_ && all.size() == module_count_ ? all[module] : base::Vec6<double>{};
  }

  /// Modules move as rigid bodies: u + theta x r.
  void announce_displacement() {
    announce_point_array(
        "displacement_mm",
        [this](std::size_t module, const Triple& corner) {
          const base::Vec6<double> u = displacement(module);
          return sum(first_half(u), cross(second_half(u), corner));
        },
        [this](std::size_t module) { return first_half(displacement(module)); });
  }

  /// A yes or no per module, and per connection whether it is so at either end.
  template <class Fact>
  void announce_fact(const char* name, Fact fact) {
    announce_cell_array(
        name, [this, fact](std::size_t i) { return flag(fact(robot_.modules()[i])); },
        [this, fact](std::size_t i) {
          const auto& [a, b, direction] = robot_.connections()[i];
          return flag(fact(robot_.modules()[static_cast<std::size_t>(a)]) ||
                      fact(robot_.modules()[static_cast<std::size_t>(b)]));
        });
  }

  void announce_facts() {
    announce_cell_array(
        "kind", [](std::size_t) { return flag(false); }, [](std::size_t) { return flag(true); });
    const auto index = [](std::size_t i) { return static_cast<std::int32_t>(i); };
    announce_cell_array("index", index, index);
    const auto lattice = [this](std::size_t module) {
      const base::Cell& cell = robot_.modules()[module].cell;
      return std::array<std::int32_t, 3>{cell.x, cell.y, cell.z};
    };
    announce_cell_array("cell", lattice, [this, lattice](std::size_t i) {
      return lattice(static_cast<std::size_t>(robot_.connections()[i].a));
    });
    announce_fact("planned", [](const model::Module& module) { return module.is_planned; });
    announce_fact("fixed", [](const model::Module& module) {
      return module.support == model::Support::kFixed;
    });
    announce_cell_array(
        "on_ground",
        [this](std::size_t i) {
          return flag(robot_.modules()[i].support == model::Support::kGround);
        },
        [](std::size_t) { return flag(false); });
  }

  /// A number per connection; modules have none, which is 0.
  void announce_connection_number(const char* name, double verdict::ConnectionResult::*member) {
    announce_cell_array(
        name, [](std::size_t) { return 0.0; },
        [this, member](std::size_t i) {
          return has_loads_ ? assessment_.connections[i].*member : 0.0;
        });
  }

  void announce_loads() {
    announce_cell_array(
        "load_ratio", [this](std::size_t i) { return paints_[i].worst_ratio; },
        [this](std::size_t i) { return has_loads_ ? assessment_.connections[i].load_ratio : 0.0; });
    announce_cell_array(
        "broken", [](std::size_t) { return flag(false); },
        [this](std::size_t i) { return flag(is_broken_[i]); });
    announce_connection_number("axial_n", &verdict::ConnectionResult::axial_n);
    announce_connection_number("bending_nmm", &verdict::ConnectionResult::bending_nmm);
    announce_connection_number("shear_n", &verdict::ConnectionResult::shear_n);
    announce_connection_number("torsion_nmm", &verdict::ConnectionResult::torsion_nmm);
  }

  base::Vec6<double> ground_force(std::size_t module) const {
    const auto& all = assessment_.equilibrium.ground_force;
    return has_loads_ && all.size() == module_count_ ? all[module] : base::Vec6<double>{};
  }

  void announce_ground() {
    const auto none = [](std::size_t) { return Triple{}; };
    const bool is_known =
        has_loads_ && assessment_.equilibrium.contact.size() == robot_.facets().size();
    announce_cell_array(
        "contact",
        [this, is_known](std::size_t i) {
          return is_known ? pressing_corners(robot_.modules()[i].support,
                                             solver::contact_of(robot_, assessment_.equilibrium, i))
                          : kNotOnGround;
        },
        [](std::size_t) { return kNotOnGround; });
    announce_cell_array(
        "ground_force_n", [this](std::size_t i) { return first_half(ground_force(i)); }, none);
    announce_cell_array(
        "ground_torque_nmm", [this](std::size_t i) { return second_half(ground_force(i)); }, none);
    announce_cell_array(
        "rotation_rad", [this](std::size_t i) { return second_half(displacement(i)); }, none);
  }

  std::ostream& out_;
  const model::Robot& robot_;
  const verdict::Assessment& assessment_;
  std::size_t module_count_;
  std::size_t connection_count_;
  std::vector<ModulePaint> paints_;
  std::vector<bool> is_broken_;  ///< By connection.
  bool has_loads_ = false;
  VtuArrays arrays_;
};

}  // namespace

void write_vtu(std::ostream& out, const model::Robot& robot, const verdict::Assessment& assessment,
               const WriteOptions& options) {
  if (out.tellp() >= 0) {
    Writer(out, robot, assessment, options).write();
    return;
  }
  std::ostringstream whole;
  Writer(whole, robot, assessment, options).write();
  out << whole.str();
}

}  // namespace holdfast::io
