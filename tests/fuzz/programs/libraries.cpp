// The header-only parsers behind the OBJ and glTF readers, instrumented like the readers themselves, so that libFuzzer
// follows its input into them.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
#include <tiny_obj_loader.h>
