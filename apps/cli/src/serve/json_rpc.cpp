// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "serve/protocol.hpp"

namespace holdfast::cli {
namespace {

/// The cells of a parameter; no value if it is no array of cells.
std::optional<std::vector<base::Cell>> read_cells(const Json& value) {
  if (!value.is_array()) {
    return std::nullopt;
  }
  std::vector<base::Cell> cells;
  for (const Json& each : value) {
    const auto is_coordinate = [](const Json& v) {
      return v.is_number_integer() && v >= -base::kCoordinateMax && v <= base::kCoordinateMax;
    };
    if (!each.is_array() || each.size() != 3 || !std::ranges::all_of(each, is_coordinate)) {
      return std::nullopt;
    }
    cells.push_back(
        {each[0].get<std::int32_t>(), each[1].get<std::int32_t>(), each[2].get<std::int32_t>()});
  }
  return cells;
}

std::string write_trials(const std::vector<Trial>& trials) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kCompact);
  json.begin_object();
  json.key("candidates");
  json.begin_array();
  for (const Trial& trial : trials) {
    write_candidate(json, trial);
  }
  json.end_array();
  json.end_object();
  return text;
}

class JsonRpcProtocol : public Protocol {
 public:
  explicit JsonRpcProtocol(const Program& program) : program_(program) {}

  Reply take(const std::string& method, const Json& parameters) override {
    if (std::ranges::count(kServedCommands, method) > 0) {
      return take_command(method, parameters);
    }
    if (method == "load") {
      return load(parameters);
    }
    if (method == "unload") {
      return unload(parameters);
    }
    if (method == "loaded") {
      return {.result = text_of({{"structures", kept_.names()}})};
    }
    if (method == "try") {
      return try_cells(parameters);
    }
    if (method == "methods") {
      return {.result = text_of(methods())};
    }
    if (method == "cancel") {
      return cancel(parameters);
    }
    if (method == "shutdown") {
      return {.result = "null", .is_shutdown = true};
    }
    return Reply::failed(
        RpcCode::kUnknownMethod,
        fmt::format("unknown method '{}'; the method 'methods' lists them", io::one_line(method)));
  }

  Reply answer(const Finished& finished) override {
    if (auto failure = find_failure(finished)) {
      return {.error = std::move(failure)};
    }
    std::string result =
        fmt::format("{{\"exit_code\":{},\"text\":{},\"notes\":{}", finished.exit_code,
                    json_string(finished.text), text_of(finished.notes));
    if (!finished.report.empty()) {
      result += ",\"report\":" + finished.report;
    }
    if (!finished.outputs.empty()) {
      Json outputs = Json::object();
      for (const auto& [name, bytes] : finished.outputs) {
        outputs[name] = content_of(bytes);
      }
      result += ",\"outputs\":" + text_of(outputs);
    }
    return {.result = result + "}"};
  }

  std::optional<Json> progress_token(const Json& id, const Json& parameters) const override {
    return parameters.value("progress", Json()) == true ? std::optional(id) : std::nullopt;
  }

  std::string progress(const Json& token, int, const std::string& text) const override {
    return fmt::format(
        "{{\"jsonrpc\":\"2.0\",\"method\":\"progress\",\"params\":{{\"id\":{},\"text\":{}}}}}",
        text_of(token), json_string(text));
  }

  bool answers_cancelled() const override { return true; }

 private:
  Reply take_command(const std::string& method, Json parameters) {
    parameters.erase("progress");
    auto call = make_call(*program_.find(method), parameters, kept_, ++count_);
    if (!call) {
      return Reply::failed(RpcCode::kInvalidParameters, call.error().message);
    }
    return {.call = std::move(call).value()};
  }

  Reply load(const Json& parameters) {
    const bool has_text = parameters.contains("text");
    const Json structure = parameters.value(has_text ? "text" : "structure", Json());
    const Json name = parameters.value("name", Json());
    if (!name.is_string() || parameters.size() != 2 ||
        (has_text ? !structure.is_string() : !structure.is_structured())) {
      return Reply::failed(RpcCode::kInvalidParameters,
                           "expected 'name', and 'text' (a string) or 'structure' (JSON)");
    }
    auto loaded = kept_.load(name.get<std::string>(),
                             has_text ? structure.get<std::string>() : text_of(structure));
    if (!loaded) {
      return Reply::failed(RpcCode::kBadInput, describe(loaded.error(), name.get<std::string>()));
    }
    return {.result = text_of(loaded.value())};
  }

  Reply unload(const Json& parameters) {
    const Json name = parameters.value("name", Json());
    if (!name.is_string() || !kept_.unload(name.get<std::string>())) {
      return Reply::failed(RpcCode::kInvalidParameters, "expected 'name' of a loaded structure");
    }
    return {.result = "null"};
  }

  Reply try_cells(const Json& parameters) {
    const Json name = parameters.value("structure", Json());
    const auto cells = read_cells(parameters.value("cells", Json()));
    if (!name.is_string() || !cells || parameters.size() != 2) {
      return Reply::failed(
          RpcCode::kInvalidParameters,
          "expected 'structure' (the name of a loaded one) and 'cells' ([[x, y, z], ...])");
    }
    const auto trials = kept_.try_cells(name.get<std::string>(), *cells);
    if (!trials) {
      return Reply::failed(RpcCode::kBadInput, trials.error().message);
    }
    return {.result = write_trials(trials.value())};
  }

  static Reply cancel(const Json& parameters) {
    if (!parameters.contains("id")) {
      return Reply::failed(RpcCode::kInvalidParameters, "expected 'id' of a request");
    }
    return {.result = "null", .cancelled = parameters["id"]};
  }

  Json methods() const {
    Json all = Json::object();
    for (const char* name : kServedCommands) {
      const CLI::App& command = *program_.find(name);
      all[name] = {{"description", command.get_description()}, {"parameters", schema_of(command)}};
    }
    return {{"methods", all}};
  }

  const Program& program_;
  KeptStructures kept_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Protocol> json_rpc_protocol(const Program& program) {
  return std::make_unique<JsonRpcProtocol>(program);
}

}  // namespace holdfast::cli
