// VTK's parser of its XML files (.vts and its kin) with quicker ways through base64 and zlib, on
// which VTK spends most of its time (tests/bench/TABLE.md).
#pragma once

#include <vtkXMLDataParser.h>

namespace qtet {

/// A new parser, which the caller owns. It reads what vtkXMLDataParser reads, to the byte, and
/// fails where that fails. It also fails where base64 ends within an array, which VTK passes over.
/// And it fails where the sizes of compressed blocks contradict each other, which VTK does not
/// survive.
[[nodiscard]] vtkXMLDataParser* newFastXmlParser();

/// One of VTK's XML readers, with that parser.
template <class Reader>
class FastXmlReader : public Reader {
 public:
  static FastXmlReader* New() {
    auto* reader = new FastXmlReader;
    reader->InitializeObjectBase();
    return reader;
  }
  FastXmlReader(const FastXmlReader&) = delete;
  FastXmlReader& operator=(const FastXmlReader&) = delete;

 protected:
  FastXmlReader() = default;
  ~FastXmlReader() override = default;
  void CreateXMLParser() override {
    if (this->XMLParser) this->DestroyXMLParser();
    this->XMLParser = newFastXmlParser();
  }
};

}  // namespace qtet
