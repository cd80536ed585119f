# Writes a Debian package's compressed documents into the working folder: changelog.gz (the
# project's own), changelog.Debian.gz (of the packages) and qtet-server.1.gz.
#   cmake -DSOURCE=. -DVERSION=1.2.3-1 -DMAINTAINER="NAME <ADDRESS>" -P documents.cmake
cmake_minimum_required(VERSION 3.25)

# The packages are as old as the newest release that CHANGELOG.md dates.
file(STRINGS ${SOURCE}/CHANGELOG.md dated REGEX "^## .*[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]$")
list(GET dated 0 newest)
string(REGEX MATCH "[0-9-]+$" day "${newest}")
execute_process(COMMAND date -u -R -d ${day} OUTPUT_VARIABLE date
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)

file(STRINGS /etc/os-release suite REGEX "^VERSION_CODENAME=")
string(REPLACE "VERSION_CODENAME=" "" suite "${suite}")
file(WRITE changelog.Debian "qtet (${VERSION}) ${suite}; urgency=medium\n\n"
  "  * Packages of this release: see changelog.gz.\n\n -- ${MAINTAINER}  ${date}\n")
file(COPY_FILE ${SOURCE}/CHANGELOG.md changelog)
file(COPY_FILE ${SOURCE}/.packaging/qtet-server.1 qtet-server.1)
execute_process(COMMAND gzip -9nf changelog changelog.Debian qtet-server.1
  COMMAND_ERROR_IS_FATAL ANY)
