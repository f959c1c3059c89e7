// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/call.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "commands.hpp"

namespace holdfast::cli {
namespace {

constexpr std::array kHidden = {"help", "quiet", "json", "vtk", "trace", "threads"};
constexpr std::array kStructureNames = {"FILE", "TARGET", "FROM", "TO", "START", "PLAN"};

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  std::ranges::replace(text, '-', '_');
  return text;
}

std::string name_of(const CLI::Option& option) {
  if (!option.get_positional()) {
    return lower_case(option.get_lnames().front());
  }
  const std::string name = option.get_name(true);
  return name == "FILE" ? "structure" : lower_case(name);
}

ParameterKind kind_of(const CLI::Option& option) {
  const std::string what = option.get_positional() ? option.get_name(true) : option.get_type_name();
  const bool is_output = option.get_group() == kOutputs;
  if (option.get_items_expected_max() == 0) {
    return ParameterKind::kFlag;
  }
  if (is_output && (what == "FILE" || what == "STEPS.json")) {
    return ParameterKind::kOutput;
  }
  if (!is_output && std::ranges::count(kStructureNames, what) > 0) {
    return ParameterKind::kStructure;
  }
  return option.get_items_expected_max() > 1 ? ParameterKind::kList : ParameterKind::kValue;
}

/// Makes one call of the parameters of one request.
class CallMaker {
 public:
  CallMaker(const CLI::App& command, const KeptStructures& kept, std::uint64_t number)
      : kept_(kept), number_(number), parameters_(parameters_of(command)) {
    call_.method = command.get_name();
  }

  base::Result<Call> make(const Json& given, bool has_report) {
    if (auto fault = find_stranger(given)) {
      return base::bad_input(*fault);
    }
    for (const Parameter& parameter : parameters_) {
      const auto value = given.find(parameter.name);
      const bool is_given = value != given.end() && !value->is_null();
      if (!is_given && parameter.option->get_required()) {
        return fail(fmt::format("the parameter '{}' is missing", parameter.name));
      }
      if (is_given) {
        if (auto fault = add(parameter, *value)) {
          return fail(fmt::format("{}: {}", parameter.name, *fault));
        }
      }
    }
    finish(has_report);
    return std::move(call_);
  }

 private:
  using Fault = std::optional<std::string>;

  base::Error fail(const std::string& message) {
    remove_files(call_);
    return base::bad_input(message);
  }

  Fault find_stranger(const Json& given) const {
    for (const auto& [name, value] : given.items()) {
      if (std::ranges::find(parameters_, name, &Parameter::name) == parameters_.end()) {
        std::vector<std::string_view> known;
        std::ranges::transform(parameters_, std::back_inserter(known),
                               [](const Parameter& each) { return std::string_view(each.name); });
        const auto near = io::near_miss(name, known);
        return fmt::format("{} has no parameter '{}'{}", call_.method, io::one_line(name),
                           near ? fmt::format("; did you mean '{}'?", *near) : std::string());
      }
    }
    return std::nullopt;
  }

  Fault add(const Parameter& parameter, const Json& value) {
    switch (parameter.kind) {
      case ParameterKind::kStructure:
        return add_structure(parameter, value);
      case ParameterKind::kFlag:
        return add_flag(parameter, value);
      case ParameterKind::kOutput:
        return add_output(parameter, value);
      case ParameterKind::kValue:
      case ParameterKind::kList:
        break;
    }
    return add_values(parameter, value);
  }

  Fault add_structure(const Parameter& parameter, const Json& value) {
    if (!value.is_string() && !value.is_object() && !value.is_array()) {
      return "expected a structure in JSON, its text, or the name of a loaded one, found " +
             std::string(cli::kind_of(value));
    }
    const std::string text = value.is_string() ? value.get<std::string>() : text_of(value);
    if (value.is_string() && kept_.has(text)) {
      add_text(parameter, text);
      return std::nullopt;
    }
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const char begin = first == std::string::npos ? '\0' : text[first];
    if (begin != '{' && begin != '[' && begin != '<' && text.find('\n') == std::string::npos) {
      return fmt::format("no structure '{}' is loaded", io::one_line(text));
    }
    const std::string file = fmt::format("request-{}-{}.{}", number_, parameter.name,
                                         begin == '<'                   ? "xml"
                                         : begin == '{' || begin == '[' ? "json"
                                                                        : "txt");
    if (const auto error = write_file(file, text)) {
      return error->message;
    }
    call_.inputs.push_back(file);
    add_text(parameter, file);
    return std::nullopt;
  }

  Fault add_flag(const Parameter& parameter, const Json& value) {
    if (!value.is_boolean()) {
      return "expected true or false, found " + std::string(cli::kind_of(value));
    }
    if (value.get<bool>()) {
      options_.push_back("--" + parameter.option->get_lnames().front());
    }
    return std::nullopt;
  }

  Fault add_output(const Parameter& parameter, const Json& value) {
    const std::string usual = parameter.name == "output" || parameter.name == "certificate"
                                  ? "json"
                                  : (parameter.name == "story" ? "txt" : parameter.name);
    const std::string ending = value.is_string() ? value.get<std::string>() : usual;
    const bool is_ending = !ending.empty() && ending.size() < 9 &&
                           std::ranges::all_of(ending, [](char c) { return c >= 'a' && c <= 'z'; });
    if (value == false) {
      return std::nullopt;
    }
    if ((!value.is_boolean() && !value.is_string()) || !is_ending) {
      return "expected true or the ending of a file such as \"svg\"";
    }
    const std::string file = fmt::format("request-{}-{}.{}", number_, parameter.name, ending);
    call_.outputs.push_back({parameter.name, file});
    add_text(parameter, file);
    return std::nullopt;
  }

  Fault add_values(const Parameter& parameter, const Json& value) {
    const bool is_cell = value.is_array() && !value.empty() &&
                         std::ranges::all_of(value, [](const Json& v) { return v.is_number(); }) &&
                         parameter.option->get_type_name().find(',') != std::string::npos;
    if (is_cell) {
      std::string cell;
      for (const Json& each : value) {
        cell += (cell.empty() ? "" : ",") + text_of(each);
      }
      add_text(parameter, cell);
      return std::nullopt;
    }
    if (parameter.kind == ParameterKind::kList && value.is_object()) {
      for (const auto& [name, each] : value.items()) {
        add_text(parameter, name + "=" + plain(each));
      }
      return std::nullopt;
    }
    const bool is_list = parameter.kind == ParameterKind::kList && value.is_array();
    for (const Json& each : is_list ? value : Json::array({value})) {
      if (!each.is_number() && !each.is_string()) {
        return fmt::format("expected a number or a string, found {}", cli::kind_of(each));
      }
      add_text(parameter, plain(each));
    }
    return std::nullopt;
  }

  static std::string plain(const Json& value) {
    return value.is_string() ? value.get<std::string>() : text_of(value);
  }

  void add_text(const Parameter& parameter, const std::string& text) {
    if (parameter.is_positional()) {
      positional_.push_back(text);
    } else {
      options_.push_back("--" + parameter.option->get_lnames().front() + "=" + text);
    }
  }

  void finish(bool has_report) {
    call_.arguments.push_back(call_.method);
    if (has_report) {
      call_.report = fmt::format("request-{}-report.json", number_);
      call_.arguments.push_back("--json=" + call_.report);
    }
    std::ranges::move(options_, std::back_inserter(call_.arguments));
    call_.arguments.emplace_back("--");
    std::ranges::move(positional_, std::back_inserter(call_.arguments));
  }

  const KeptStructures& kept_;
  std::uint64_t number_;
  std::vector<Parameter> parameters_;
  Call call_;
  std::vector<std::string> options_;
  std::vector<std::string> positional_;
};

Json any_of_structures() {
  return {{"anyOf", Json::array({{{"type", "object"},
                                  {"description",
                                   "A structure as holdfast JSON, such as "
                                   "{\"format\": \"holdfast-structure\", \"version\": 1, "
                                   "\"modules\": [[0,0,0], [0,0,1]]}"}},
                                 {{"type", "array"},
                                  {"description", "The cells of the modules, [x,y,z] each"}},
                                 {{"type", "string"},
                                  {"description",
                                   "The name of a loaded structure, or the text of "
                                   "one in any format that is read"}}})}};
}

Json property_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::kStructure:
      return any_of_structures();
    case ParameterKind::kFlag:
      return {{"type", "boolean"}};
    case ParameterKind::kOutput:
      return {{"type", {"boolean", "string"}}};
    case ParameterKind::kList:
      return {{"type", {"array", "object", "string", "number"}}};
    case ParameterKind::kValue:
      break;
  }
  return {{"type", {"number", "string", "array"}}};
}

}  // namespace

std::vector<Parameter> parameters_of(const CLI::App& command) {
  std::vector<Parameter> parameters;
  for (const CLI::Option* option : command.get_options()) {
    const bool is_positional = option->get_positional();
    if (is_positional || std::ranges::count(kHidden, option->get_lnames().front()) == 0) {
      parameters.push_back({name_of(*option), kind_of(*option), option});
    }
  }
  std::stable_partition(parameters.begin(), parameters.end(),
                        [](const Parameter& each) { return each.is_positional(); });
  return parameters;
}

base::Result<Call> make_call(const CLI::App& command, const Json& parameters,
                             const KeptStructures& kept, std::uint64_t number) {
  return CallMaker(command, kept, number)
      .make(parameters, command.get_option_no_throw("--json") != nullptr);
}

void remove_files(const Call& call) {
  std::error_code ignored;
  for (const std::string& input : call.inputs) {
    std::filesystem::remove(input, ignored);
  }
  for (const CallOutput& output : call.outputs) {
    std::filesystem::remove(output.file, ignored);
  }
  if (!call.report.empty()) {
    std::filesystem::remove(call.report, ignored);
  }
}

Json schema_of(const CLI::App& command) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Parameter& parameter : parameters_of(command)) {
    Json property = property_of(parameter);
    std::string what = parameter.option->get_description();
    if (parameter.kind == ParameterKind::kOutput) {
      what += "; true, or the ending that says the format. It comes back in the answer";
    }
    property["description"] = what;
    if (!parameter.option->get_default_str().empty()) {
      property["default"] = parameter.option->get_default_str();
    }
    properties[parameter.name] = property;
    if (parameter.option->get_required()) {
      required.push_back(parameter.name);
    }
  }
  return {{"type", "object"},
          {"properties", properties},
          {"required", required},
          {"additionalProperties", false}};
}

}  // namespace holdfast::cli
