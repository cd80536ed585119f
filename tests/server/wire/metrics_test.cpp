#include "server/wire/metrics.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace qtet {
namespace {

using namespace std::chrono_literals;

bool holds(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(RequestKind, routesAreNamedByTheirPath) {
  struct Case {
    std::string target;
    RouteLabel route;
  };
  using enum RouteLabel;
  for (const Case& one : {Case{"/", kViewer},
                          Case{"/assets/a.js", kViewer},
                          Case{"/openapi.json", kViewer},
                          Case{"/livez", kAdmin},
                          Case{"/metrics?x=1", kAdmin},
                          Case{"/metrics/x", kViewer},
                          Case{"/v1", kOther},
                          Case{"/v1/nothing", kOther},
                          Case{"/v1/meshes?limit=2", kMeshes},
                          Case{"/v1/meshes/a", kMesh},
                          Case{"/v1/meshes/a/log", kMesh},
                          Case{"/v1/logs/a/log", kLog},
                          Case{"/v1/logs/a", kLog},
                          Case{"/v1/logs/a/levels/3.vtu", kLevel},
                          Case{"/v1/logs/a/poster.webp", kPoster},
                          Case{"/v1/tickets", kTickets},
                          Case{"/v1/stream?ticket=a", kStream},
                          Case{"*", kOther},
                          Case{"/%", kOther},
                          Case{"", kOther}})
    EXPECT_EQ(kindOf("GET", one.target).route, one.route) << one.target;
}

TEST(RequestKind, aMethodOfTheClientsOwnMakesNoLabel) {
  EXPECT_EQ(kMethodLabels[kindOf("PUT", "/").method], "PUT");
  for (const char* odd : {"", "get", "SURPRISE", "other", "PATCH"})
    EXPECT_EQ(kMethodLabels[kindOf(odd, "/").method], "other") << odd;
}

TEST(Metrics, numbersAreTheShortestDecimalsThatSayTheSame) {
  const Metrics metrics;
  const auto written = [&](double value) {
    const std::string text = metrics.text({{"figure", "It.", false, value}});
    const std::string name = "\nqtet_figure ";
    const std::size_t at = text.find(name) + name.size();
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(written(0.005), "0.005");
  EXPECT_EQ(written(0.1), "0.1");
  EXPECT_EQ(written(0), "0");
  EXPECT_EQ(written(-2.5), "-2.5");
  EXPECT_EQ(written(0.0001), "0.0001");
  EXPECT_EQ(written(0.00001), "1e-05");
  EXPECT_EQ(written(1'795'660'800), "1795660800");
  EXPECT_EQ(written(1e20), "100000000000000000000");
  EXPECT_EQ(written(1e21), "1e+21");
}

TEST(Metrics, timesAreCountedByRouteAndMethod) {
  Metrics metrics;
  const RequestKind log = kindOf("GET", "/v1/logs/a/log"), put = kindOf("PUT", "/v1/meshes/a");
  metrics.countRequest(log, 200, 10, 5ms);
  metrics.countRequest(log, 206, 10, 5ms + 1ns);
  metrics.countRequest(put, 201, 0, 600s);
  metrics.countRequest(put, 422, 0, 600s + 1ns);
  const std::string text = metrics.text({});
  const std::string name = "qtet_http_request_duration_seconds";
  const std::string ofLog = "{route=\"log\",method=\"GET\"",
                    ofPut = "{route=\"mesh\",method=\"PUT\"";
  EXPECT_TRUE(holds(text, name + "_bucket" + ofLog + ",le=\"0.001\"} 0")) << text;
  EXPECT_TRUE(holds(text, name + "_bucket" + ofLog + ",le=\"0.005\"} 1"));
  EXPECT_TRUE(holds(text, name + "_bucket" + ofLog + ",le=\"0.01\"} 2"));
  EXPECT_TRUE(holds(text, name + "_count" + ofLog + "} 2"));
  EXPECT_TRUE(holds(text, name + "_bucket" + ofPut + ",le=\"300\"} 0"));
  EXPECT_TRUE(holds(text, name + "_bucket" + ofPut + ",le=\"600\"} 1"));
  EXPECT_TRUE(holds(text, name + "_bucket" + ofPut + ",le=\"+Inf\"} 2"));
  EXPECT_TRUE(holds(text, "qtet_uploads_failed_total 1"));
  EXPECT_EQ(text.find("poster"), std::string::npos) << "nothing was asked of it";
}

TEST(Metrics, refusalsAreCountedByReason) {
  Metrics metrics;
  for (const unsigned status : {200u, 404u, 401u, 403u, 429u, 413u, 431u, 507u, 503u})
    metrics.countRequest(kindOf("GET", "/v1/meshes"), status, 0, 1ms);
  metrics.countRequest(kindOf("GET", "/readyz"), 503, 0, 1ms);
  metrics.countFailedHandshake();
  const std::string text = metrics.text({});
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"auth\"} 2")) << text;
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"rate\"} 1"));
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"size\"} 3"));
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"busy\"} 1"));
  EXPECT_TRUE(holds(text, "qtet_tls_handshakes_failed_total 1"));
}

TEST(Metrics, aRefusalWhoseReasonIsKnownIsNotCountedByItsStatus) {
  Metrics metrics;
  const RequestKind meshes = kindOf("GET", "/v1/meshes");
  metrics.countRequest(meshes, 429, 0, 1ms, Refusal::kCredit);
  metrics.countRequest(meshes, 429, 0, 1ms, Refusal::kPlaces);
  metrics.countRequest(meshes, 503, 0, 1ms, Refusal::kPlaces);
  const std::string text = metrics.text({});
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"credit\"} 1")) << text;
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"places\"} 2"));
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"rate\"} 0"));
  EXPECT_TRUE(holds(text, "qtet_refusals_total{reason=\"busy\"} 0"));
  EXPECT_EQ(text.find("reason=\"\""), std::string::npos) << "what was not refused has no line";
}

TEST(Metrics, figuresOfOneNameHaveOneHead) {
  const std::string text = Metrics().text(
      {{"kept", "It.", false, 1, "{cache=\"a\"}"}, {"kept", "It.", false, 2, "{cache=\"b\"}"}});
  EXPECT_TRUE(
      text.ends_with("\n# HELP qtet_kept It.\n# TYPE qtet_kept gauge\n"
                     "qtet_kept{cache=\"a\"} 1\nqtet_kept{cache=\"b\"} 2\n"))
      << text;
}

}  // namespace
}  // namespace qtet
