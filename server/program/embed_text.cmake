# cmake -DIN=FILE -DOUT=FILE.cpp -P embed_text.cmake: the text of IN as qtet::openApiJson().
file(READ ${IN} text)
file(WRITE ${OUT} "#include \"server/routes/openapi.h\"\n\nnamespace qtet {\n\nstd::string openApiJson() {\n  return R\"openapi(${text})openapi\";\n}\n\n}  // namespace qtet\n")
