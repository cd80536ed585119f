export interface Repository {
  type: string;
  url: string;
  directory: string;
}
export function repositoryOf(url: string): Repository | undefined;
export function originOf(folder: string): string;
