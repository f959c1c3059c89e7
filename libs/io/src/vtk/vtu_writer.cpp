// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <sstream>
#include <type_traits>

#include "holdfast/io/picture.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/verdict/connection_law.hpp"
#include "obstacle_cells.hpp"
#include "shapes/module_paint.hpp"
#include "shapes/svg_text.hpp"
#include "vtk/vtu_arrays.hpp"
#include "vtk/vtu_shape.hpp"

// Cells are the modules in the robot's order, then the connections and the facets in theirs, then
// the cells of obstacles. Points are those of the shape of each module, then the centre of each,
// between which the connections run, then the four corners of each facet, then those of the shape
// of each obstacle cell, which is a module's. What is not known is written as 0, and has_loads says
// so.
namespace holdfast::io {
namespace {

using Triple = Place;

constexpr std::uint8_t kVtkLine = 3;
constexpr std::uint8_t kVtkQuad = 9;
constexpr std::int8_t kNotOnGround = -1;
constexpr std::int8_t kNoDirection = -1;
constexpr std::int8_t kNoLimit = -1;
constexpr std::size_t kFacetCornerCount = 4;

/// A facet's corners in its frame, in halves of its width.
constexpr std::array<std::array<double, 2>, kFacetCornerCount> kFacetCorners = {
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};

/// The thing that a cell of the file stands for.
enum class CellKind : std::uint8_t { kModule, kConnection, kFacet, kObstacle };

/// The value that is written: 0 for what is not finite, else rounded to 32 bits, more than nine
/// digits, as fewer bits take less room and time.
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

/// VTK's name of a type.
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

Triple first_half(const base::Vec6<double>& vector) { return {vector[0], vector[1], vector[2]}; }

Triple second_half(const base::Vec6<double>& vector) { return {vector[3], vector[4], vector[5]}; }

/// (exp(theta) - 1) r, by Rodrigues' formula.
Triple turned(const Triple& theta, const Triple& r) {
  const double angle = std::sqrt(theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2]);
  const Triple once = cross(theta, r);
  if (angle == 0) {
    return once;
  }
  const double half = std::sin(angle / 2) / (angle / 2);
  return sum(scaled(std::sin(angle) / angle, once), scaled(half * half / 2, cross(theta, once)));
}

/// The number of pressing corners of a facet: 0 (open), 1, 2 (an edge) or 4 (closed).
std::int8_t pressing_corners(const mechanics::ContactState& state) {
  if (!state.pressed) {
    return 0;
  }
  return static_cast<std::int8_t>((state.tilt_x != 0 ? 1 : 2) * (state.tilt_y != 0 ? 1 : 2));
}

/// A yes or no, as arrays have it.
std::uint8_t flag(bool is_so) { return is_so ? 1 : 0; }

class Writer {
 public:
  /// The modules from `shown_count` on are not shown, but for their connections to those before.
  Writer(std::ostream& out, const model::Robot& robot, std::size_t shown_count,
         const verdict::Assessment& assessment, const WriteOptions& options,
         std::span<const model::Obstacle> obstacles, std::optional<double> factor = {})
      : out_(out),
        robot_(robot),
        assessment_(assessment),
        more_(options.more),
        module_count_(robot.modules().size()),
        shown_count_(shown_count),
        connection_count_(robot.connections().size()),
        facet_count_(robot.facets().size()),
        obstacles_(obstacles_near(robot, obstacles).cells),
        shape_(vtu_shape(robot.lattice())),
        laws_(robot),
        paints_(paint_modules(robot, assessment)),
        is_broken_(connection_count_, false),
        has_loads_(has_loads(robot, assessment)),
        factor_(factor),
        arrays_(out, options) {
    for (const std::size_t connection : assessment.broken) {
      is_broken_[connection] = true;
    }
    for (const base::Direction direction : base::facet_directions(robot.lattice())) {
      axes_.push_back(model::rotation_along<double>(robot.lattice(), direction));
    }
  }

  void write() {
    out_ << "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\""
         << VtuArrays::compressor() << ">\n<UnstructuredGrid>\n";
    write_field_data();
    out_ << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", point_count(),
                        cell_count());
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
    announce_more();
    out_ << "</CellData>\n</Piece>\n</UnstructuredGrid>\n";
    arrays_.write();
    out_ << "</VTKFile>\n";
  }

  /// Writes the file that says which arrays all pieces have, and which files these are.
  void write_index(std::span<const std::string> pieces) {
    arrays_.list_only();
    out_ << "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n";
    write_field_data();
    out_ << "<PPoints>\n";
    announce_points();
    out_ << "</PPoints>\n<PPointData Vectors=\"displacement_mm\">\n";
    announce_displacement();
    out_ << "</PPointData>\n<PCellData Scalars=\"load_ratio\">\n";
    announce_facts();
    announce_loads();
    announce_ground();
    announce_more();
    out_ << "</PCellData>\n";
    for (const std::string& piece : pieces) {
      out_ << fmt::format("<Piece Source=\"{}\"/>\n", piece);
    }
    out_ << "</PUnstructuredGrid>\n</VTKFile>\n";
  }

 private:
  /// A value that says the same of all cells of a kind.
  template <class Value>
  static auto always(Value value) {
    return [value](std::size_t) { return value; };
  }

  /// Lines run between the centres of modules; without lines there are no centres.
  std::size_t centre_count() const { return connection_count_ > 0 ? module_count_ : 0; }

  std::size_t corner_count() const { return shape_.points.size() * shown_count_; }

  /// Points of modules, their centres, facets.
  std::size_t robot_point_count() const {
    return corner_count() + centre_count() + kFacetCornerCount * facet_count_;
  }

  std::size_t point_count() const {
    return robot_point_count() + shape_.points.size() * obstacles_.size();
  }

  std::size_t cell_count() const {
    return shown_count_ + connection_count_ + facet_count_ + obstacles_.size();
  }

  /// The functions give the value of a cell for the index of a module, a connection, a facet, an
  /// obstacle cell.
  template <class OfModule, class OfConnection, class OfFacet, class OfObstacle>
  void announce_cell_array(const char* name, OfModule of_module, OfConnection of_connection,
                           OfFacet of_facet, OfObstacle of_obstacle) {
    using Value = decltype(of_module(std::size_t{}));
    static_assert(std::is_same_v<Value, decltype(of_connection(std::size_t{}))> &&
                  std::is_same_v<Value, decltype(of_facet(std::size_t{}))> &&
                  std::is_same_v<Value, decltype(of_obstacle(std::size_t{}))>);
    arrays_.announce(make_array(
        name, cell_count(), [this, of_module, of_connection, of_facet, of_obstacle](std::size_t i) {
          if (i < shown_count_) {
            return of_module(i);
          }
          i -= shown_count_;
          if (i < connection_count_) {
            return of_connection(i);
          }
          i -= connection_count_;
          return i < facet_count_ ? of_facet(i) : of_obstacle(i - facet_count_);
        }));
  }

  /// An array in which obstacles have nothing, which is 0.
  template <class OfModule, class OfConnection, class OfFacet>
  void announce_cell_array(const char* name, OfModule of_module, OfConnection of_connection,
                           OfFacet of_facet) {
    announce_cell_array(name, of_module, of_connection, of_facet,
                        always(decltype(of_module(std::size_t{})){}));
  }

  /// Announces an array by point: `of_point` gets a module and a point of it, from its node, mm;
  /// `of_obstacle` a cell and the same.
  template <class OfPoint, class OfObstacle>
  void announce_point_array(const char* name, OfPoint of_point, OfObstacle of_obstacle) {
    const double pitch = robot_.material().pitch_mm;
    const auto of_any = [this, pitch, of_point, of_obstacle](std::size_t i) {
      const std::size_t per_module = shape_.points.size();
      if (i >= robot_point_count()) {
        i -= robot_point_count();
        return of_obstacle(obstacles_[i / per_module].cell,
                           scaled(pitch, shape_.points[i % per_module]));
      }
      if (i < corner_count()) {
        return of_point(i / per_module, scaled(pitch, shape_.points[i % per_module]));
      }
      if (i < corner_count() + centre_count()) {
        return of_point(i - corner_count(), Triple{});
      }
      const std::size_t place = i - corner_count() - centre_count();
      const model::Facet& facet = robot_.facets()[place / kFacetCornerCount];
      return of_point(static_cast<std::size_t>(facet.module),
                      facet_corner(facet, kFacetCorners[place % kFacetCornerCount]));
    };
    arrays_.announce(make_array(name, point_count(), of_any));
  }

  Triple facet_corner(const model::Facet& facet, const std::array<double, 2>& corner) const {
    const auto& axes = axes_[static_cast<std::size_t>(base::index(facet.direction))];
    const double half_width = robot_.foot_half_width_mm();
    const Triple middle = scaled(robot_.material().pitch_mm / 2,
                                 base::way_to_neighbour(robot_.lattice(), facet.direction));
    return sum(middle, sum(scaled(corner[0] * half_width, axes[0]),
                           scaled(corner[1] * half_width, axes[1])));
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
        "NumberOfTuples=\"1\" format=\"ascii\">\n{}\n</DataArray>\n<DataArray type=\"Float64\" "
        "Name=\"gravity_m_s2\" NumberOfComponents=\"3\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n{:.9g} {:.9g} {:.9g}\n</DataArray>\n",
        std::isfinite(largest) ? largest + 0.0 : 0.0, flag(has_loads_), robot_.gravity()[0] + 0.0,
        robot_.gravity()[1] + 0.0, robot_.gravity()[2] + 0.0);
    if (factor_) {
      out_ << fmt::format(
          "<DataArray type=\"Float64\" Name=\"load_factor\" NumberOfTuples=\"1\" "
          "format=\"ascii\">\n{:.9g}\n</DataArray>\n",
          *factor_);
    }
    out_ << "</FieldData>\n";
  }

  Triple centre(const base::Cell& cell) const {
    return scaled(robot_.material().pitch_mm, base::node_place(robot_.lattice(), cell));
  }

  void announce_points() {
    const auto beside = [this](const base::Cell& cell, const Triple& point) {
      return sum(centre(cell), point);
    };
    announce_point_array(
        "Points",
        [this, beside](std::size_t module, const Triple& point) {
          return beside(robot_.modules()[module].cell, point);
        },
        beside);
  }

  /// Connections share the centres; all other cells have their points one behind the other.
  std::int64_t point_at(std::size_t i) const {
    const std::size_t corners = corner_count();
    if (i < corners) {
      return static_cast<std::int64_t>(i);
    }
    if (i < corners + 2 * connection_count_) {
      const model::Connection& pair = robot_.connections()[(i - corners) / 2];
      return static_cast<std::int64_t>(corners) + ((i - corners) % 2 == 0 ? pair.a : pair.b);
    }
    return static_cast<std::int64_t>(i - 2 * connection_count_ + centre_count());
  }

  void announce_cells() {
    const std::size_t corners = corner_count();
    arrays_.announce(make_array("connectivity",
                                point_count() - centre_count() + 2 * connection_count_,
                                [this](std::size_t i) { return point_at(i); }));
    const auto offset = [](std::size_t before, std::size_t each, std::size_t i) {
      return static_cast<std::int64_t>(before + each * (i + 1));
    };
    announce_cell_array(
        "offsets", [=, each = shape_.points.size()](std::size_t i) { return offset(0, each, i); },
        [=](std::size_t i) { return offset(corners, 2, i); },
        [=, before = corners + 2 * connection_count_](std::size_t i) {
          return offset(before, kFacetCornerCount, i);
        },
        [=, each = shape_.points.size(),
         before = corners + 2 * connection_count_ + kFacetCornerCount * facet_count_](
            std::size_t i) { return offset(before, each, i); });
    announce_cell_array("types", always(shape_.type), always(kVtkLine), always(kVtkQuad),
                        always(shape_.type));
  }

  base::Vec6<double> displacement(std::size_t module) const {
    const auto& all = assessment_.equilibrium.displacement;
    const bool is_known = has_loads_ || factor_;
    return is_known && all.size() == module_count_ ? all[module] : base::Vec6<double>{};
  }

  /// Modules move as rigid bodies, their facets with them: u + theta x r, or at large rotations
  /// u + (exp(theta) - 1) r.
  void announce_displacement() {
    announce_point_array(
        "displacement_mm",
        [this](std::size_t module, const Triple& point) {
          const base::Vec6<double> u = displacement(module);
          return sum(first_half(u),
                     factor_ ? turned(second_half(u), point) : cross(second_half(u), point));
        },
        [](const base::Cell&, const Triple&) { return Triple{}; });
  }

  std::size_t module_of(std::size_t facet) const {
    return static_cast<std::size_t>(robot_.facets()[facet].module);
  }

  /// A yes or no per module, per connection whether it is so at either end, per facet of its
  /// module.
  template <class Fact>
  void announce_fact(const char* name, Fact fact) {
    const auto of_module = [this, fact](std::size_t i) { return flag(fact(robot_.modules()[i])); };
    announce_cell_array(
        name, of_module,
        [this, fact](std::size_t i) {
          const auto& [a, b, direction] = robot_.connections()[i];
          return flag(fact(robot_.modules()[static_cast<std::size_t>(a)]) ||
                      fact(robot_.modules()[static_cast<std::size_t>(b)]));
        },
        [this, of_module](std::size_t i) { return of_module(module_of(i)); });
  }

  void announce_facts() {
    const auto number = [](CellKind kind) { return always(static_cast<std::uint8_t>(kind)); };
    announce_cell_array("kind", number(CellKind::kModule), number(CellKind::kConnection),
                        number(CellKind::kFacet), number(CellKind::kObstacle));
    const auto index = [](std::size_t i) { return static_cast<std::int32_t>(i); };
    announce_cell_array("index", index, index, index, index);
    const auto numbers = [](const base::Cell& cell) {
      return std::array<std::int32_t, 3>{cell.x, cell.y, cell.z};
    };
    const auto lattice = [this, numbers](std::size_t module) {
      return numbers(robot_.modules()[module].cell);
    };
    announce_cell_array(
        "cell", lattice,
        [this, lattice](std::size_t i) {
          return lattice(static_cast<std::size_t>(robot_.connections()[i].a));
        },
        [this, lattice](std::size_t i) { return lattice(module_of(i)); },
        [this, numbers](std::size_t i) { return numbers(obstacles_[i].cell); });
    const auto direction = [](base::Direction of) {
      return static_cast<std::int8_t>(base::index(of));
    };
    announce_cell_array(
        "direction", always(kNoDirection),
        [this, direction](std::size_t i) { return direction(robot_.connections()[i].direction); },
        [this, direction](std::size_t i) { return direction(robot_.facets()[i].direction); },
        always(kNoDirection));
    announce_fact("planned", [](const model::Module& module) { return module.is_planned; });
    announce_fact("fixed", [](const model::Module& module) {
      return module.support == model::Support::kFixed;
    });
    announce_cell_array(
        "on_ground",
        [this](std::size_t i) {
          return flag(robot_.modules()[i].support == model::Support::kGround);
        },
        always(flag(false)), always(flag(true)));
    announce_cell_array(
        "bonded", always(flag(false)), always(flag(false)),
        [this](std::size_t i) { return flag(robot_.facets()[i].is_bonded()); },
        [this](std::size_t i) { return flag(obstacles_[i].is_bonded); });
  }

  /// A number per connection; modules and facets have none, which is 0.
  void announce_connection_number(const char* name, double verdict::ConnectionResult::*member) {
    announce_cell_array(
        name, always(0.0),
        [this, member](std::size_t i) {
          return has_loads_ ? assessment_.connections[i].*member : 0.0;
        },
        always(0.0));
  }

  void announce_loads() {
    announce_cell_array(
        "load_ratio", [this](std::size_t i) { return paints_[i].worst_ratio; },
        [this](std::size_t i) { return has_loads_ ? assessment_.connections[i].load_ratio : 0.0; },
        always(0.0));
    announce_cell_array(
        "broken", always(flag(false)), [this](std::size_t i) { return flag(is_broken_[i]); },
        always(flag(false)));
    announce_connection_number("axial_n", &verdict::ConnectionResult::axial_n);
    announce_connection_number("bending_nmm", &verdict::ConnectionResult::bending_nmm);
    announce_connection_number("shear_n", &verdict::ConnectionResult::shear_n);
    announce_connection_number("torsion_nmm", &verdict::ConnectionResult::torsion_nmm);
    announce_cell_array(
        "limit", always(kNoLimit),
        [this](std::size_t i) {
          return has_loads_ ? static_cast<std::int8_t>(
                                  laws_.limit(robot_.connections()[i], assessment_.connections[i]))
                            : kNoLimit;
        },
        always(kNoLimit), always(kNoLimit));
    announce_cell_array(
        "gap_mm", always(0.0), [this](std::size_t i) { return gap(i); }, always(0.0));
    const auto load = [this](std::size_t i) { return robot_.loads()[i]; };
    announce_cell_array(
        "load_n", [load](std::size_t i) { return first_half(load(i)); }, always(Triple{}),
        always(Triple{}));
    announce_cell_array(
        "load_nmm", [load](std::size_t i) { return second_half(load(i)); }, always(Triple{}),
        always(Triple{}));
  }

  double gap(std::size_t connection) const {
    const solver::Equilibrium& equilibrium = assessment_.equilibrium;
    if (has_loads_ && !assessment_.gaps_mm.empty()) {
      return assessment_.gaps_mm[connection];
    }
    return has_loads_ && equilibrium.displacement.size() == module_count_
               ? laws_.gap_mm(robot_.connections()[connection], equilibrium.displacement,
                              equilibrium.displacement_low)
               : 0;
  }

  base::Vec6<double> facet_force(std::size_t facet) const {
    const auto& all = assessment_.equilibrium.facet_force;
    return has_loads_ && all.size() == facet_count_ ? all[facet] : base::Vec6<double>{};
  }

  std::int8_t contact(std::size_t facet) const {
    const auto& states = assessment_.equilibrium.contact;
    const bool is_known = has_loads_ && states.size() == facet_count_;
    return is_known ? pressing_corners(states[facet]) : kNotOnGround;
  }

  /// The largest number of pressing corners of any facet, by module.
  std::vector<std::int8_t> contact_by_module() const {
    std::vector<std::int8_t> most(module_count_, kNotOnGround);
    for (std::size_t facet = 0; facet < facet_count_; ++facet) {
      std::int8_t& corners = most[module_of(facet)];
      corners = std::max(corners, contact(facet));
    }
    return most;
  }

  void announce_ground() {
    announce_cell_array(
        "contact", [most = contact_by_module()](std::size_t i) { return most[i]; },
        always(kNotOnGround), [this](std::size_t i) { return contact(i); }, always(kNotOnGround));
    if (has_loads_) {
      ground_forces_ = solver::ground_forces(robot_, assessment_.equilibrium);
    }
    ground_forces_.resize(module_count_);
    announce_cell_array(
        "ground_force_n", [this](std::size_t i) { return first_half(ground_forces_[i]); },
        always(Triple{}), [this](std::size_t i) { return first_half(facet_force(i)); });
    announce_cell_array(
        "ground_torque_nmm", [this](std::size_t i) { return second_half(ground_forces_[i]); },
        always(Triple{}), [this](std::size_t i) { return second_half(facet_force(i)); });
    const auto rotation = [this](std::size_t i) { return second_half(displacement(i)); };
    announce_cell_array("rotation_rad", rotation, always(Triple{}),
                        [this, rotation](std::size_t i) { return rotation(module_of(i)); });
  }

  void announce_more() {
    const auto of = [](const std::vector<double>& list) {
      return [&list](std::size_t i) { return list.empty() ? 0.0 : list[i]; };
    };
    for (const MoreNumbers& field : more_) {
      announce_cell_array(field.name.c_str(), of(field.modules), of(field.connections),
                          of(field.facets));
    }
  }

  std::ostream& out_;
  const model::Robot& robot_;
  const verdict::Assessment& assessment_;
  const std::vector<MoreNumbers>& more_;
  std::size_t module_count_;
  std::size_t shown_count_;
  std::size_t connection_count_;
  std::size_t facet_count_;
  std::vector<ObstacleCell> obstacles_;
  VtuShape shape_;
  verdict::ConnectionLaws laws_;
  std::vector<model::Rotation<double>> axes_;  ///< Of facets, by direction.
  std::vector<ModulePaint> paints_;
  std::vector<bool> is_broken_;  ///< By connection.
  bool has_loads_ = false;
  std::optional<double> factor_;                   ///< Of the loads, in the deformed shape.
  std::vector<base::Vec6<double>> ground_forces_;  ///< By module.
  VtuArrays arrays_;
};

}  // namespace

namespace {

void write_whole_vtu(std::ostream& out, const model::Robot& robot,
                     const verdict::Assessment& assessment, const WriteOptions& options,
                     std::span<const model::Obstacle> obstacles, std::optional<double> factor) {
  const auto write = [&](std::ostream& into) {
    Writer(into, robot, robot.modules().size(), assessment, options, obstacles, factor).write();
  };
  if (out.tellp() >= 0) {
    write(out);
    return;
  }
  std::ostringstream whole;
  write(whole);
  out << whole.str();
}

}  // namespace

void write_vtu(std::ostream& out, const model::Robot& robot, const verdict::Assessment& assessment,
               const WriteOptions& options, std::span<const model::Obstacle> obstacles) {
  write_whole_vtu(out, robot, assessment, options, obstacles, std::nullopt);
}

void write_deformed_vtu(std::ostream& out, const model::Robot& robot,
                        const verdict::Assessment& assessment, double factor,
                        const WriteOptions& options, std::span<const model::Obstacle> obstacles) {
  write_whole_vtu(out, robot, assessment, options, obstacles, factor);
}

void write_vtu_piece(std::ostream& out, const model::Robot& part, std::size_t own_count,
                     const verdict::Assessment& assessment, const WriteOptions& options) {
  Writer(out, part, own_count, assessment, options, {}).write();
}

void write_pvtu(std::ostream& out, const model::Robot& part, const verdict::Assessment& assessment,
                std::span<const std::string> pieces) {
  Writer(out, part, 0, assessment, {}, {}).write_index(pieces);
}

void write_pvd(std::ostream& out, std::span<const SeriesFile> files) {
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n";
  for (const SeriesFile& file : files) {
    out << fmt::format("    <DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", file.time,
                       file.part, escape(file.name));
  }
  out << "  </Collection>\n</VTKFile>\n";
}

}  // namespace holdfast::io
