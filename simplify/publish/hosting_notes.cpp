#include "simplify/publish/hosting_notes.h"

#include "proto/version.h"

namespace qtet {

std::string hostingNotes() {
  return "Meshes for the browser, published by qtet " + version() + R"(

index.html shows the meshes of index.json. Each is one .qtet file. Copy this folder to any web
server; no program runs there. Addresses:

    https://HOST/FOLDER/                     the first mesh, and a menu of the others
    https://HOST/FOLDER/?mesh=NAME           one mesh; the page keeps the view in its address
    <iframe src="https://HOST/FOLDER/?mesh=NAME"></iframe>

'qtet publish' makes the folder anew as a whole and leaves nothing in it that it did not write.

What a server should do, the most important first:

Range        Answer byte ranges of .qtet files, and do not compress these. Then a mesh comes coarse
             first and only as far as it is looked at. Without ranges it is fetched whole.
Compression  Send NAME.br or NAME.gz for NAME to browsers that take it: a third of the bytes.
Types        .js text/javascript, .wasm application/wasm, .json application/json,
             .qtet application/octet-stream.
Caching      Files in assets/ never change, because their names hold a hash of their contents.
             Everything else has to be asked for again (no-cache).
CORS         Only for pages of other sites that show these meshes:
             Access-Control-Allow-Origin: *

nginx:
    server {
      listen 80;
      server_name meshes.example.org;
      root /var/www/meshes;
      gzip_static on;
      gzip_vary on;
      # brotli_static on;  # with the module brotli (Debian: libnginx-mod-http-brotli-static)
      add_header Cache-Control no-cache;
      add_header Access-Control-Allow-Origin *;
      add_header Access-Control-Expose-Headers "Accept-Ranges, Content-Range, ETag";
      location /assets/ {
        add_header Cache-Control "public, max-age=31536000, immutable";
        add_header Access-Control-Allow-Origin *;
      }
    }

Caddy:
    meshes.example.org {
      root * /var/www/meshes
      @changing not path /assets/*
      header @changing Cache-Control no-cache
      header /assets/* Cache-Control "public, max-age=31536000, immutable"
      header Access-Control-Allow-Origin *
      header Access-Control-Expose-Headers "Accept-Ranges, Content-Range, ETag"
      file_server {
        precompressed br gzip
      }
    }

S3 and CloudFront:
    # CloudFront compresses by itself, so the compressed files stay at home.
    aws s3 sync . s3://BUCKET --exclude '*.gz' --exclude '*.br' --exclude 'assets/*' \
      --cache-control no-cache
    aws s3 sync assets s3://BUCKET/assets --exclude '*.gz' --exclude '*.br' --exclude '*.wasm' \
      --cache-control 'public, max-age=31536000, immutable'
    aws s3 cp assets s3://BUCKET/assets --recursive --exclude '*' --include '*.wasm' \
      --content-type application/wasm --cache-control 'public, max-age=31536000, immutable'
    # The distribution: default root object index.html, cache policy CachingOptimized, "Compress
    # objects automatically", response headers policy CORS-With-Preflight. Ranges need nothing.

GitHub Pages:
    # Commit the contents of this folder, .nojekyll too, to the branch or folder that Pages serves.
    # It compresses, answers ranges and allows CORS by itself. A file may have 100 MB, a site 1 GB.

A server that knows nothing, to look at it here:
    python3 -m http.server --directory .     # then http://127.0.0.1:8000/; no ranges
)";
}

}  // namespace qtet
