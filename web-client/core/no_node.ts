// Stands in for Node's modules, which draco3d names for its use outside of browsers and never touches here.
export default {};
