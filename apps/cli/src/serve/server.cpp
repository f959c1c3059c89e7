// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/server.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <exception>
#include <vector>

#include "interruption.hpp"

namespace holdfast::cli {
namespace {

/// Tasks that wait for their turn; as long as there are so many no further input is read.
constexpr std::size_t kTasksMax = 1000;
/// Bytes of answers that nobody has read; likewise.
constexpr std::size_t kOutputMax = std::size_t{1} << 26U;
constexpr int kTickMs = 100;

std::string message_of(const std::optional<Json>& id, const Reply& reply) {
  const std::string head =
      fmt::format("{{\"jsonrpc\":\"2.0\",\"id\":{},", id ? text_of(*id) : "null");
  if (!reply.error) {
    return head + "\"result\":" + reply.result + "}";
  }
  return head + fmt::format("\"error\":{{\"code\":{},\"message\":{}}}}}",
                            static_cast<int>(reply.error->code), json_string(reply.error->message));
}

/// What is wrong with a message as JSON-RPC has it; empty if nothing is.
std::string find_fault(const Json& message) {
  if (!message.is_object()) {
    return fmt::format("expected an object, found {}", kind_of(message));
  }
  if (message.value("jsonrpc", Json()) != "2.0") {
    return "expected \"jsonrpc\": \"2.0\"";
  }
  if (!message.value("method", Json()).is_string()) {
    return "expected 'method', a string";
  }
  const Json id = message.value("id", Json());
  if (!id.is_null() && !id.is_string() && !id.is_number()) {
    return "expected 'id' to be a string or a number";
  }
  return "";
}

}  // namespace

void Server::run() {
  const Interruption interruption;
  ::signal(SIGPIPE, SIG_IGN);
  while (!is_gone_ && !Interruption::is_here() && has_work()) {
    start_tasks();
    wait();
    finish_tasks();
  }
  tasks_.clear();
}

bool Server::has_work() const {
  return !is_written() || (!is_shut_down_ && (!is_input_over_ || !tasks_.empty()));
}

bool Server::is_waiting_for_input() const {
  return !is_input_over_ && !is_shut_down_ && tasks_.size() < kTasksMax &&
         output_.size() - written_ < kOutputMax;
}

void Server::wait() {
  std::vector<pollfd> polled;
  std::vector<Task*> owners;
  const auto add = [&](int descriptor, Task* owner) {
    if (descriptor >= 0) {
      polled.push_back({.fd = descriptor, .events = POLLIN, .revents = 0});
      owners.push_back(owner);
    }
  };
  add(is_waiting_for_input() ? STDIN_FILENO : -1, nullptr);
  if (!is_written()) {
    polled.push_back({.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0});
    owners.push_back(nullptr);
  }
  for (Task& task : tasks_) {
    if (task.running) {
      add(task.running->output(), &task);
      add(task.running->errors(), &task);
    }
  }
  if (::poll(polled.data(), polled.size(), tasks_.empty() ? -1 : kTickMs) <= 0) {
    return;
  }
  for (std::size_t i = 0; i < polled.size(); ++i) {
    if (polled[i].revents == 0) {
      continue;
    }
    if (owners[i] != nullptr) {
      take_outputs(*owners[i], polled[i].fd);
    } else if (polled[i].fd == STDOUT_FILENO) {
      write_what_fits();
    } else {
      take_input();
    }
  }
}

void Server::take_outputs(Task& task, int descriptor) {
  for (const std::string& text : task.running->take(descriptor)) {
    if (task.token && !task.is_cancelled) {
      write_line(protocol_->progress(*task.token, ++task.progress_count, text));
    }
  }
}

void Server::take_input() {
  char buffer[1U << 16U];
  const ssize_t size = ::read(STDIN_FILENO, buffer, sizeof buffer);
  if (size < 0 && errno == EINTR) {
    return;
  }
  if (size <= 0) {
    is_input_over_ = true;
    take_line(lines_.rest());
    return;
  }
  const auto lines = lines_.take({buffer, static_cast<std::size_t>(size)});
  for (const std::string& line : lines.complete) {
    take_line(line);
  }
  for (int i = 0; i < lines.too_long; ++i) {
    answer(Json(), nullptr,
           Reply::failed(RpcCode::kInvalidRequest,
                         fmt::format("a request has at most {} bytes", kRequestBytesMax)));
  }
}

void Server::take_line(const std::string& line) {
  if (is_shut_down_ || line.find_first_not_of(" \t\r") == std::string::npos) {
    return;
  }
  const auto message = read_json(line);
  if (!message) {
    answer(Json(), nullptr,
           Reply::failed(
               RpcCode::kParseError,
               fmt::format("expected JSON in one line, nested at most {} deep", kJsonDepthMax)));
    return;
  }
  if (!message->is_array()) {
    take_message(*message, nullptr);
    return;
  }
  if (message->empty()) {
    answer(Json(), nullptr, Reply::failed(RpcCode::kInvalidRequest, "expected a request"));
    return;
  }
  const auto batch = std::make_shared<Batch>();
  batch->open = 1;  // This loop.
  for (const Json& each : *message) {
    take_message(each, batch);
  }
  if (--batch->open == 0 && !batch->answers.empty()) {
    write_line("[" + batch->answers + "]");
  }
}

void Server::take_message(const Json& message, const std::shared_ptr<Batch>& batch) {
  if (batch) {
    ++batch->open;
  }
  const std::string fault = find_fault(message);
  if (!fault.empty()) {
    answer(Json(), batch, Reply::failed(RpcCode::kInvalidRequest, fault));
    return;
  }
  const std::optional<Json> id =
      message.contains("id") ? std::optional(message["id"]) : std::nullopt;
  try {
    take_request(message, id, batch);
  } catch (const std::exception& error) {  // Such as memory that runs out.
    answer(id, batch, Reply::failed(RpcCode::kFailure, error.what()));
  }
}

void Server::take_request(const Json& message, const std::optional<Json>& id,
                          const std::shared_ptr<Batch>& batch) {
  const Json parameters = message.value("params", Json::object());
  const auto is_same = [&](const Task& task) { return id && task.id == id; };
  if (!parameters.is_object()) {
    answer(id, batch,
           Reply::failed(
               RpcCode::kInvalidParameters,
               fmt::format("expected 'params' to be an object, found {}", kind_of(parameters))));
    return;
  }
  if (std::ranges::any_of(tasks_, is_same)) {
    answer(id, batch,
           Reply::failed(RpcCode::kInvalidRequest, "a request of this id is still being answered"));
    return;
  }
  Reply reply = protocol_->take(message["method"].get<std::string>(), parameters);
  if (reply.call) {
    tasks_.push_back({.id = id,
                      .batch = batch,
                      .token = id ? protocol_->progress_token(*id, parameters) : std::nullopt,
                      .call = std::move(*reply.call)});
    return;
  }
  if (reply.cancelled) {
    cancel(*reply.cancelled);
  }
  answer(id, batch, reply);
  is_shut_down_ = is_shut_down_ || reply.is_shutdown;
}

void Server::cancel(const Json& id) {
  const auto task = std::ranges::find(tasks_, std::optional(id), &Task::id);
  if (task == tasks_.end()) {
    return;
  }
  task->is_cancelled = true;
  if (task->running) {
    task->running->cancel();
  }
}

void Server::start_tasks() {
  std::size_t count = 0;
  for (Task& task : tasks_) {
    if (count++ >= options_.job_count) {
      return;
    }
    if (!task.running && !task.is_cancelled) {
      try {
        task.running.emplace(std::move(task.call), program_, options_.limits);
      } catch (const std::exception& error) {
        answer(task.id, task.batch, Reply::failed(RpcCode::kFailure, error.what()));
        task.is_cancelled = true;
        task.id.reset();
        task.batch.reset();
      }
    }
  }
}

void Server::finish_tasks() {
  for (auto task = tasks_.begin(); task != tasks_.end();) {
    if (task->running) {
      task->running->tick();
    }
    const bool is_over = task->running ? task->running->is_over() : task->is_cancelled;
    if (!is_over) {
      ++task;
      continue;
    }
    const auto reply = task->running ? protocol_->answer(task->running->finish())
                                     : Reply::failed(RpcCode::kCancelled, "cancelled");
    if (!task->is_cancelled || protocol_->answers_cancelled()) {
      answer(task->id, task->batch, reply);
    }
    task = tasks_.erase(task);
  }
}

void Server::answer(const std::optional<Json>& id, const std::shared_ptr<Batch>& batch,
                    const Reply& reply) {
  if (!batch) {
    if (id) {
      write_line(message_of(id, reply));
    }
    return;
  }
  if (id) {
    batch->answers += (batch->answers.empty() ? "" : ",") + message_of(id, reply);
  }
  if (--batch->open == 0 && !batch->answers.empty()) {
    write_line("[" + batch->answers + "]");
  }
}

void Server::write_line(const std::string& line) {
  output_ += line + "\n";
  write_what_fits();
}

void Server::write_what_fits() {
  pollfd polled = {.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  while (!is_written() && ::poll(&polled, 1, 0) > 0) {
    const std::size_t size = std::min<std::size_t>(PIPE_BUF, output_.size() - written_);
    const ssize_t count = ::write(STDOUT_FILENO, output_.data() + written_, size);
    if (count < 0 && errno != EINTR) {
      is_gone_ = true;  // Nobody reads any more.
      written_ = output_.size();
    }
    written_ += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  if (is_written()) {
    output_.clear();
    written_ = 0;
  }
}

}  // namespace holdfast::cli
