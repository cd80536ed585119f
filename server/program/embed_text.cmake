# cmake -DIN=FILE -DOUT=FILE.cpp -P embed_text.cmake: the text of IN as qtet::openApiJson().
file(READ ${IN} text)
file(WRITE ${OUT} "#include \"server/routes/openapi.h\"

namespace qtet {

std::string openApiJson() {
  return R\"openapi(${text})openapi\";
}

}  // namespace qtet
")
