/** Files chosen in a file dialog. */
export function chosen(event: Event): File[] {
  const input = event.target as HTMLInputElement;
  const files = [...(input.files ?? [])];
  // Choosing the same file again must fire a change event.
  input.value = "";
  return files;
}
