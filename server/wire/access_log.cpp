#include "server/wire/access_log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "proto/json_reader.h"

namespace qtet {
namespace {

constexpr unsigned kSwitchingProtocols = 101;

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

void addTrace(Json& line, const RequestTrace& trace) {
  line["id"] = trace.id;
  if (trace.traceId.empty()) return;
  line["traceId"] = trace.traceId;
  line["parentId"] = trace.parentId;
  line["spanId"] = trace.spanId;
}

Result<std::shared_ptr<spdlog::logger>> openLogger(const std::string& path) {
  try {
    std::shared_ptr<spdlog::sinks::sink> sink;
    if (path == "-")
      sink = std::make_shared<spdlog::sinks::stdout_sink_mt>();
    else
      sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path);
    auto logger = std::make_shared<spdlog::logger>("access", std::move(sink));
    // The time stands in front of the members that `write` gives, UTC with milliseconds.
    logger->set_formatter(std::make_unique<spdlog::pattern_formatter>(
        R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ",%v)", spdlog::pattern_time_type::utc));
    logger->flush_on(spdlog::level::info);
    return logger;
  } catch (const spdlog::spdlog_ex& e) {
    return fail(ErrorCode::kIo, "the access log " + path + " cannot be written: " + e.what());
  }
}

}  // namespace

AccessLog::AccessLog(std::string path, std::shared_ptr<spdlog::logger> logger)
    : path_(std::move(path)), logger_(std::move(logger)) {}
AccessLog::~AccessLog() { logger_->flush(); }

Result<std::unique_ptr<AccessLog>> AccessLog::open(const std::string& path) {
  Result<std::shared_ptr<spdlog::logger>> logger = openLogger(path);
  if (!logger) return std::unexpected(logger.error());
  return std::unique_ptr<AccessLog>(new AccessLog(path, std::move(*logger)));
}

Status AccessLog::reopen() {
  Result<std::shared_ptr<spdlog::logger>> fresh = openLogger(path_);
  if (!fresh) return std::unexpected(fresh.error());
  const std::scoped_lock lock(mutex_);
  logger_.swap(*fresh);
  return {};
}

std::shared_ptr<spdlog::logger> AccessLog::logger() const {
  const std::scoped_lock lock(mutex_);
  return logger_;
}

void AccessLog::write(const AccessEntry& entry, const RequestTrace& trace) {
  Json line = {{"client", entry.client}, {"method", entry.method}, {"target", entry.target},
               {"status", entry.status}, {"bytes", entry.bytes},   {"ms", milliseconds(entry.time)},
               {"whole", entry.whole}};
  if (entry.change != nullptr)
    line["change"] = {
        {"token", entry.change->token}, {"mesh", entry.change->mesh}, {"received", entry.received}};
  addTrace(line, trace);
  logger()->info(dumpJson(line).substr(1));
}

void AccessLog::write(const StreamEntry& entry, std::string_view client, std::string_view target,
                      const RequestTrace& trace) {
  Json stream = {{"mesh", entry.mesh},
                 {"opens", entry.opens},
                 {"frames", entry.frames},
                 {"stalledMs", milliseconds(entry.stalled)},
                 {"creditWaits", entry.creditWaits},
                 {"end", entry.end}};
  if (entry.firstFrame) stream["firstFrameMs"] = milliseconds(*entry.firstFrame);
  Json line = {{"client", client},     {"method", "GET"},
               {"target", target},     {"status", kSwitchingProtocols},
               {"bytes", entry.bytes}, {"ms", milliseconds(entry.time)},
               {"stream", stream}};
  addTrace(line, trace);
  logger()->info(dumpJson(line).substr(1));
}

}  // namespace qtet
