// No secret gets into a log, wherever a client has put it.
#include "server/wire/loggable.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/wire/token_limits.h"

namespace qtet {
namespace {

const std::string kToken = "aHidden+Of/TwentyTwo=Ch";

TEST(Loggable, aTokenOfTheFileIsFoundWhereverItStands) {
  const auto tokens = Tokens::parse("read * " + kToken);
  ASSERT_TRUE(tokens);
  const std::string encoded = "aHidden%2BOf%2FTwentyTwo%3DCh";
  for (const std::string& target :
       {"/" + kToken, "/v1/meshes/" + kToken + "/manifest", "/v1/meshes/" + encoded,
        "/v1/meshes?after=" + kToken + "&limit=1", "http://a/" + encoded, kToken}) {
    EXPECT_EQ(loggableTarget(target, &*tokens), kWithheld) << target;
    EXPECT_EQ(loggableTarget(target, nullptr), target) << "nobody's secret";
  }
  EXPECT_TRUE(holdsSecret(kToken, &*tokens));
  EXPECT_FALSE(holdsSecret(kToken + "x", &*tokens));
}

TEST(Loggable, aQueryThatSpeaksOfSecretsIsCutOff) {
  for (const std::string query :
       {"token=x", "TOKEN=x", "ticket=x", "a=b&access_token=x", "%74oken=x", "Authorization=x",
        "a=Bearer%20x", "password=x", "client_secret=x"})
    EXPECT_EQ(loggableTarget("/v1/meshes?" + query, nullptr), "/v1/meshes") << query;
  for (const std::string target :
       {"/v1/meshes?limit=3&after=wing", "/v1/logs/x/log?q=%2", "/%", ""})
    EXPECT_EQ(loggableTarget(target, nullptr), target);
}

TEST(Loggable, aRunOfHexadecimalDigitsAsLongAsATicketIsOne) {
  const std::string below(limits::kTicketCharacters - 1, 'a');
  EXPECT_FALSE(holdsSecret("/v1/" + below, nullptr));
  EXPECT_TRUE(holdsSecret("/v1/" + below + "0", nullptr));
  EXPECT_TRUE(holdsSecret("/v1/" + below + "00", nullptr));
  EXPECT_TRUE(holdsSecret("/v1/%61" + below, nullptr));
}

TEST(Loggable, aTextOfTooManyPartsIsNotSearchedAndNotShown) {
  const auto tokens = Tokens::parse("read * " + kToken);
  ASSERT_TRUE(tokens);
  for (const auto& [separators, hidden] : {std::pair(14, false), {15, false}, {16, true}})
    EXPECT_EQ(holdsSecret(std::string(static_cast<std::size_t>(separators), '/'), &*tokens), hidden)
        << separators;
}

}  // namespace
}  // namespace qtet
