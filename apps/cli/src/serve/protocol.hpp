// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "program.hpp"
#include "serve/call.hpp"
#include "serve/running_call.hpp"

namespace holdfast::cli {

/// Error codes of JSON-RPC 2.0, and the server's own.
enum class RpcCode : std::int32_t {
  kParseError = -32700,
  kInvalidRequest = -32600,
  kUnknownMethod = -32601,
  kInvalidParameters = -32602,
  kBadInput = -32001,   ///< A structure cannot be read, or is none.
  kFailure = -32002,    ///< Out of memory, or a fault of the program.
  kTooLong = -32003,    ///< Ended by the server's limit.
  kCancelled = -32800,  ///< As the Language Server Protocol has it.
};

struct RpcError {
  RpcCode code = RpcCode::kFailure;
  std::string message;
};

/// What becomes of a request: an answer at once, or a call that makes it.
struct Reply {
  std::optional<RpcError> error = {};
  std::string result = {};  ///< JSON in one line.
  std::optional<Call> call = {};
  std::optional<Json> cancelled = {};  ///< The id of a request that is to end.
  bool is_shutdown = false;

  static Reply failed(RpcCode code, std::string message) {
    return {.error = RpcError{code, std::move(message)}};
  }
};

/// What clients can ask for, and how answers look.
class Protocol {
 public:
  Protocol() = default;
  Protocol(const Protocol&) = delete;
  Protocol& operator=(const Protocol&) = delete;
  virtual ~Protocol() = default;

  /// Takes a request; its parameters are an object.
  virtual Reply take(const std::string& method, const Json& parameters) = 0;

  /// The answer of a call that has ended by itself, as a reply without a call.
  virtual Reply answer(const Finished& finished) = 0;

  /// What a request gives to be told of its progress by; none if it does not want to.
  virtual std::optional<Json> progress_token(const Json& id, const Json& parameters) const = 0;

  /// A notification of progress; `count` is how many a request has had with it.
  virtual std::string progress(const Json& token, int count, const std::string& text) const = 0;

  /// Whether a request that was cancelled gets an error as its answer.
  virtual bool answers_cancelled() const = 0;
};

/// JSON-RPC 2.0, with the commands of a program, which must outlive it: every served command is a
/// method, beside load, unload, loaded, try, methods, cancel and shutdown.
std::unique_ptr<Protocol> json_rpc_protocol(const Program& program);

/// The Model Context Protocol, with the commands of a program, which must outlive it: every served
/// command is a tool, with pictures.
std::unique_ptr<Protocol> mcp_protocol(const Program& program);

/// How a finished call failed; none where its command gave an answer, whatever the verdict.
std::optional<RpcError> find_failure(const Finished& finished);

/// The content of an output as JSON: a string, or {"base64": ...} of what is not text.
Json content_of(const std::string& bytes);

std::string base64(std::string_view bytes);

}  // namespace holdfast::cli
