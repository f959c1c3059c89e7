// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "holdfast/figure_file.hpp"
#include "serve/protocol.hpp"

namespace holdfast::cli {
namespace {

/// Versions of the protocol that differ in nothing that is used here; the last is offered to
/// clients that ask for another one.
constexpr std::array kVersions = {"2024-11-05", "2025-03-26", "2025-06-18"};

/// The most connections of a report where a client does not say: the most loaded ones.
constexpr const char* kConnectionsUsual = "10";

constexpr const char* kInstructions =
    "holdfast predicts whether a modular robot holds: whether a connection between its modules is "
    "overloaded, or the robot topples. check answers for a structure; next says where one more "
    "module may go; order in which order it can be built, safe all the way; move how it gets to "
    "another shape; steps judges a sequence. A verdict is safe, overload, unstable or undecided; "
    "undecided is no permission. generate makes structures to begin with.";

/// Whether an assistant has no use for a parameter: files, and how pictures look.
bool is_hidden(const Parameter& parameter) {
  return parameter.option->get_group() == kOutputs && parameter.name != "output" &&
         parameter.name != "view";
}

/// The parameters of a command that a tool does not have.
std::vector<std::string> hidden_parameters(const CLI::App& command) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters_of(command)) {
    if (is_hidden(parameter)) {
      names.push_back(parameter.name);
    }
  }
  return names;
}

class McpProtocol : public Protocol {
 public:
  explicit McpProtocol(const Program& program) : program_(program) {}

  Reply take(const std::string& method, const Json& parameters) override {
    if (method == "initialize") {
      return {.result = text_of(introduction(parameters))};
    }
    if (method == "ping") {
      return {.result = "{}"};
    }
    if (method == "tools/list") {
      return {.result = text_of(tools())};
    }
    if (method == "tools/call") {
      return call_tool(parameters);
    }
    if (method == "notifications/cancelled" && parameters.contains("requestId")) {
      return {.result = "{}", .cancelled = parameters["requestId"]};
    }
    if (method.starts_with("notifications/")) {
      return {.result = "{}"};
    }
    return Reply::failed(RpcCode::kUnknownMethod,
                         fmt::format("unknown method '{}'", io::one_line(method)));
  }

  Reply answer(const Finished& finished) override {
    if (const auto failure = find_failure(finished)) {
      return {.result = text_of(refusal(failure->message))};
    }
    Json content = Json::array({{{"type", "text"}, {"text", text_for(finished)}}});
    for (const auto& [name, bytes] : finished.outputs) {
      content.push_back(name == "svg" ? picture_of(bytes)
                                      : Json{{"type", "text"}, {"text", bytes}});
    }
    std::string result = "{\"content\":" + text_of(content) + ",\"isError\":false";
    if (!finished.report.empty()) {
      result += ",\"structuredContent\":" + finished.report;
    }
    return {.result = result + "}"};
  }

  std::optional<Json> progress_token(const Json&, const Json& parameters) const override {
    const Json meta = parameters.value("_meta", Json::object());
    const Json token = meta.is_object() ? meta.value("progressToken", Json()) : Json();
    return token.is_null() ? std::nullopt : std::optional(token);
  }

  std::string progress(const Json& token, int count, const std::string& text) const override {
    const Json parameters = {{"progressToken", token}, {"progress", count}, {"message", text}};
    return text_of(
        {{"jsonrpc", "2.0"}, {"method", "notifications/progress"}, {"params", parameters}});
  }

  bool answers_cancelled() const override { return false; }

 private:
  static Json picture_of(const std::string& bytes) {
    const char* const type = bytes.starts_with("\x89PNG") ? "image/png" : "image/svg+xml";
    return {{"type", "image"}, {"data", base64(bytes)}, {"mimeType", type}};
  }

  static Json refusal(const std::string& message) {
    return {{"content", Json::array({{{"type", "text"}, {"text", message}}})}, {"isError", true}};
  }

  static std::string text_for(const Finished& finished) {
    std::string text = finished.text;
    if (text.empty()) {  // Else the notes are in it.
      for (const std::string& note : finished.notes) {
        text += note + "\n";
      }
    }
    return text.empty() ? "done\n" : text;
  }

  static Json introduction(const Json& parameters) {
    const Json asked = parameters.value("protocolVersion", Json());
    const bool is_known =
        std::ranges::any_of(kVersions, [&](const char* version) { return asked == version; });
    return {{"protocolVersion", is_known ? asked : Json(kVersions.back())},
            {"capabilities", {{"tools", Json::object()}}},
            {"serverInfo",
             {{"name", "holdfast"}, {"title", "holdfast"}, {"version", std::string(version())}}},
            {"instructions", kInstructions}};
  }

  Json tools() const {
    Json all = Json::array();
    for (const char* name : kServedCommands) {
      const CLI::App& command = *program_.find(name);
      Json schema = schema_of(command);
      const bool has_picture = schema["properties"].contains("svg");
      for (const std::string& hidden : hidden_parameters(command)) {
        schema["properties"].erase(hidden);
      }
      if (has_picture) {
        schema["properties"]["picture"] = {{"type", "boolean"},
                                           {"description", "Answer with a picture as well"}};
      }
      all.push_back({{"name", name},
                     {"description", command.get_description()},
                     {"inputSchema", schema},
                     {"annotations", {{"readOnlyHint", true}, {"openWorldHint", false}}}});
    }
    return {{"tools", all}};
  }

  Reply call_tool(const Json& parameters) {
    const Json name = parameters.value("name", Json());
    Json arguments = parameters.value("arguments", Json::object());
    if (!name.is_string() || std::ranges::count(kServedCommands, name.get<std::string>()) == 0) {
      return Reply::failed(RpcCode::kInvalidParameters, "unknown tool " + text_of(name));
    }
    if (!arguments.is_object()) {
      return Reply::failed(RpcCode::kInvalidParameters, "expected 'arguments' to be an object");
    }
    const CLI::App& command = *program_.find(name.get<std::string>());
    for (const std::string& hidden : hidden_parameters(command)) {
      if (arguments.contains(hidden)) {
        return {.result = text_of(refusal(fmt::format("{} is no argument of a tool", hidden)))};
      }
    }
    complete(command, arguments);
    auto call = make_call(command, arguments, kept_, ++count_);
    if (!call) {
      return {.result = text_of(refusal(call.error().message))};
    }
    return {.call = std::move(call).value()};
  }

  /// A picture is a PNG where librsvg is there, else an SVG; a report has a length that can be
  /// read; a file that a command makes is wanted.
  static void complete(const CLI::App& command, Json& arguments) {
    const auto has = [&](const char* option) {
      return command.get_option_no_throw(option) != nullptr;
    };
    if (arguments.value("picture", Json()) == true && has("--svg")) {
      arguments["svg"] = find_figure_fault("picture.png") ? "svg" : "png";
    }
    if (has("--svg")) {
      arguments.erase("picture");
    }
    if (has("--connections") && !arguments.contains("connections")) {
      arguments["connections"] = kConnectionsUsual;
    }
    if (has("--output") && !has("--json") && !arguments.contains("output")) {
      arguments["output"] = true;
    }
  }

  const Program& program_;
  KeptStructures kept_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Protocol> mcp_protocol(const Program& program) {
  return std::make_unique<McpProtocol>(program);
}

}  // namespace holdfast::cli
