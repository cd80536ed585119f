#include "server/wire/access_log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "proto/json_reader.h"

namespace qtet {

AccessLog::AccessLog(std::shared_ptr<spdlog::logger> logger) : logger_(std::move(logger)) {}
AccessLog::~AccessLog() { logger_->flush(); }

Result<std::unique_ptr<AccessLog>> AccessLog::open(const std::string& path) {
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
    return std::unique_ptr<AccessLog>(new AccessLog(std::move(logger)));
  } catch (const spdlog::spdlog_ex& e) {
    return fail(ErrorCode::kIo, "the access log " + path + " cannot be written: " + e.what());
  }
}

void AccessLog::write(const AccessEntry& entry, const RequestTrace& trace) {
  Json line = {{"id", trace.id},
               {"client", entry.client},
               {"method", entry.method},
               {"target", entry.target},
               {"status", entry.status},
               {"bytes", entry.bytes},
               {"ms", std::chrono::duration<double, std::milli>(entry.time).count()},
               {"whole", entry.whole}};
  if (!trace.traceId.empty()) {
    line["traceId"] = trace.traceId;
    line["parentId"] = trace.parentId;
    line["spanId"] = trace.spanId;
  }
  logger_->info(dumpJson(line).substr(1));
}

}  // namespace qtet
