// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>

#include "serve/line_reader.hpp"
#include "serve/protocol.hpp"
#include "serve/running_call.hpp"

namespace holdfast::cli {

struct ServerOptions {
  std::size_t job_count = 1;  ///< Calls that run at the same time.
  RunningCall::Limits limits;
};

/// Answers requests, one JSON value in a line of standard input each, by lines on standard output.
/// Calls run in processes of their own, so answers come in the order in which they are ready.
class Server {
 public:
  /// The program's commands are what calls run; it must outlive the server.
  Server(Program& program, std::unique_ptr<Protocol> protocol, const ServerOptions& options)
      : program_(program), protocol_(std::move(protocol)), options_(options) {}

  /// Serves until standard input has ended and all is answered, or shutdown, a signal or a client
  /// that reads no more ends it.
  void run();

 private:
  /// The answers of the requests that came in one array, which go out in one.
  struct Batch {
    std::size_t open = 0;
    std::string answers;
  };

  /// A request that takes a call.
  struct Task {
    std::optional<Json> id;  ///< None for notifications, which are not answered.
    std::shared_ptr<Batch> batch;
    std::optional<Json> token;  ///< Of progress.
    Call call;
    std::optional<RunningCall> running = {};
    int progress_count = 0;
    bool is_cancelled = false;
  };

  void take_input();
  void take_line(const std::string& line);
  void take_message(const Json& message, const std::shared_ptr<Batch>& batch);
  void take_request(const Json& message, const std::optional<Json>& id,
                    const std::shared_ptr<Batch>& batch);
  void cancel(const Json& id);
  void start_tasks();
  void wait();
  void take_outputs(Task& task, int descriptor);
  void finish_tasks();
  bool has_work() const;
  bool is_waiting_for_input() const;

  void answer(const std::optional<Json>& id, const std::shared_ptr<Batch>& batch,
              const Reply& reply);
  void write_line(const std::string& line);

  bool is_written() const { return written_ == output_.size(); }

  void write_what_fits();

  Program& program_;
  std::unique_ptr<Protocol> protocol_;
  ServerOptions options_;
  LineReader lines_;
  std::list<Task> tasks_;
  std::string output_;  ///< Written up to `written_`: a client may write on before it reads.
  std::size_t written_ = 0;
  bool is_input_over_ = false;
  bool is_shut_down_ = false;
  bool is_gone_ = false;  ///< The client.
};

}  // namespace holdfast::cli
