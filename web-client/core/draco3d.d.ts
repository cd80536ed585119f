// The part of draco3d's decoder that is used here.

declare module 'draco3d/draco_decoder_nodejs.js' {
  export interface DracoModule {
    Decoder: new () => DracoDecoder;
    DecoderBuffer: new () => DracoBuffer;
    PointCloud: new () => DracoPointCloud;
    POINT_CLOUD: number;
    DT_INT32: number;
    HEAP32: Int32Array;
    _malloc(bytes: number): number;
    _free(address: number): void;
    destroy(object: object): void;
  }
  export interface DracoBuffer {
    Init(bytes: Int8Array, size: number): void;
  }
  export interface DracoPointCloud {
    num_points(): number;
    num_attributes(): number;
  }
  export interface DracoAttribute {
    data_type(): number;
    num_components(): number;
  }
  export interface DracoDecoder {
    GetEncodedGeometryType(buffer: DracoBuffer): number;
    DecodeBufferToPointCloud(buffer: DracoBuffer, cloud: DracoPointCloud): {ok(): boolean; error_msg(): string};
    GetAttribute(cloud: DracoPointCloud, index: number): DracoAttribute;
    GetAttributeDataArrayForAllPoints(
      cloud: DracoPointCloud, attribute: DracoAttribute, type: number, bytes: number, address: number): boolean;
  }
  export default function DracoDecoderModule(options: {
    wasmBinary?: ArrayBuffer;
    instantiateWasm?(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void): object;
  }): Promise<DracoModule>;
}
