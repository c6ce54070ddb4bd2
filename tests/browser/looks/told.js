() => [...document.querySelectorAll('[aria-live], [role=status], [role=alert], [role=log]')].map((e) => ({
  is: [e.id, ...e.classList].filter(Boolean),
  loud: e.getAttribute('aria-live') === 'assertive' || (e.getAttribute('role') === 'alert' && !e.hasAttribute('aria-live')),
  restless: [...e.querySelectorAll('[data-live], [data-countdown]')].filter((one) =>
    !one.closest('[aria-live=off]') && (one.matches('[data-countdown]')
      || !['text', 'words', 'who', 'freshness', 'date', ''].includes(one.dataset.form ?? ''))).map((one) => one.outerHTML.slice(0, 120)),
}))
