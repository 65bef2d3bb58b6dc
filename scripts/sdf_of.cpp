// Prints libsdformat's conversion of each URDF on the command line.
#include <iostream>
#include <sdf/sdf.hh>

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    sdf::SDFPtr sdf(new sdf::SDF());
    sdf::init(sdf);
    sdf::Errors errors;
    sdf::readFile(argv[i], sdf, errors);
    std::cout << sdf->Root()->ToString("") << '\0';
  }
}
