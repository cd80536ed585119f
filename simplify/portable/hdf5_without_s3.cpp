// Debian's static HDF5 can read files from Amazon's S3, and names functions of libcurl and OpenSSL
// for it. qtet opens files on disk alone, so these are never called.
#include <cstdlib>

#define QTET_NEVER_CALLED(name) \
  extern "C" void name();       \
  extern "C" void name() { std::abort(); }

QTET_NEVER_CALLED(curl_easy_cleanup)
QTET_NEVER_CALLED(curl_easy_init)
QTET_NEVER_CALLED(curl_easy_perform)
QTET_NEVER_CALLED(curl_easy_setopt)
QTET_NEVER_CALLED(curl_global_cleanup)
QTET_NEVER_CALLED(curl_global_init)
QTET_NEVER_CALLED(curl_slist_append)
QTET_NEVER_CALLED(curl_slist_free_all)
QTET_NEVER_CALLED(EVP_sha256)
QTET_NEVER_CALLED(HMAC)
QTET_NEVER_CALLED(SHA256)
