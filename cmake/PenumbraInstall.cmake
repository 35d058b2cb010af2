# Installation: the program, and the package that find_package(Penumbra CONFIG) finds.
